//! Fuzzes project files: a project that can be read is unchanged by writing and reading it again.
#![no_main]

use morphospace::project::Project;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let project = match Project::parse(text) {
        Ok(project) => project,
        Err(error) => {
            assert!(
                !error.to_string().chars().any(char::is_control),
                "{error:?}"
            );
            return;
        }
    };
    let written = project.to_toml().expect("a project that was read can be written");
    let reread = Project::parse(&written).expect("a project that was written can be read");
    assert_eq!(project, reread);
});

//! Any text as a project: what is read can be written, and reads the same.
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
    let written = project.to_toml().expect("what was read can be written");
    let again = Project::parse(&written).expect("what was written can be read");
    assert_eq!(project, again);
});

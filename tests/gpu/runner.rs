//! A test runner that prints results like Rust's own, and counts all tests as ignored if there is
//! no GPU.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use crate::GpuTest;
use crate::offscreen::OffscreenRenderer;

/// Runs the tests whose names contain the first command-line argument that is not a flag, or all
/// tests if there is no such argument. Prints the results like Rust's own runner. `--list` only
/// lists the tests.
#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
pub fn run(tests: &[GpuTest]) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let filter = arguments.iter().find(|a| !a.starts_with('-'));
    let is_chosen = |name: &str| filter.is_none_or(|f| name.contains(f.as_str()));
    let chosen: Vec<&GpuTest> = tests.iter().filter(|(name, _)| is_chosen(name)).collect();
    if arguments.iter().any(|a| a == "--list") {
        chosen.iter().for_each(|(name, _)| println!("{name}: test"));
        return ExitCode::SUCCESS;
    }
    println!("\nrunning {} tests", chosen.len());
    let Some(mut renderer) = OffscreenRenderer::open(None) else {
        return report_no_adapter(&chosen);
    };
    println!("on {}", renderer.adapter());
    let mut failed = 0;
    for (name, test) in &chosen {
        let result = catch_unwind(AssertUnwindSafe(|| test(&mut renderer)));
        let word = if result.is_ok() { "ok" } else { "FAILED" };
        failed += usize::from(result.is_err());
        println!("test {name} ... {word}");
    }
    print_summary(chosen.len() - failed, failed, 0)
}

#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
fn report_no_adapter(chosen: &[&GpuTest]) -> ExitCode {
    for (name, _) in chosen {
        println!("test {name} ... ignored, there is no graphics adapter");
    }
    let required = std::env::var_os("MORPHOSPACE_REQUIRE_GPU").is_some_and(|v| v == "1");
    if required {
        println!("\nMORPHOSPACE_REQUIRE_GPU is set, but there is no graphics adapter");
        return print_summary(0, chosen.len(), 0);
    }
    print_summary(0, 0, chosen.len())
}

#[expect(clippy::print_stdout, reason = "a test runner reports on stdout")]
fn print_summary(passed: usize, failed: usize, ignored: usize) -> ExitCode {
    let word = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "\ntest result: {word}. {passed} passed; {failed} failed; {ignored} ignored; \
         0 measured; 0 filtered out\n"
    );
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

//! Tests of hostile input: files and arguments that are made to break the program. Each is given to
//! the program in a child process.
//!
//! The program must end by itself with the right exit code and within limits on memory and time.
//! Its error must be one line that names the file and contains no terminal control characters. The
//! tests generate all files.

mod bounded_run;
mod broken_pictures;
mod endless_fonts;
mod expansion_bombs;
mod extreme_numbers;
mod fonts;
mod large_images;
mod proofs;
mod special_files;
mod stored_matches;
mod terminal_escapes;

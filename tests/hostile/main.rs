//! Hostile input: files and arguments made to break the program, each given to a child process.
//!
//! The program must end by itself with the right exit status and within its limits of memory and
//! time. Its error is one line that names the file and contains no terminal control characters.
//! All files are generated here; valid designs that are only slow are not tested here.

mod bounded_run;
mod expansion_bombs;
mod extreme_numbers;
mod large_images;
mod special_files;
mod terminal_escapes;

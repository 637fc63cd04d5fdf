//! Files and arguments that were made to break the program, each given to it
//! as a child process: it ends by itself with the right status, within the
//! memory and the time that it promises, and what it says is one line that
//! names the file and holds nothing that acts on a terminal.
//!
//! All of them are made here, small ones of their kinds. Not here: designs
//! that are good and only laborious.

mod bombs;
mod child;
mod kinds;
mod numbers;
mod pictures;
mod words;

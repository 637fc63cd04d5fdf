//! Protection of input files: no command writes over a file that it reads.

use std::path::{Path, PathBuf};

use crate::design::DesignSource;
use crate::io::file_id::FileId;

use super::error::CliError;

/// Existing files that a command reads.
#[derive(Clone, Debug, Default)]
pub(super) struct InputFiles(Vec<(PathBuf, FileId)>);

impl InputFiles {
    /// Adds a file. A missing file is left out: the command reports it when it reads it.
    pub fn with_file(mut self, path: &Path) -> Self {
        self.0
            .extend(FileId::of(path).map(|id| (path.to_owned(), id)));
        self
    }

    /// Adds the files of designs, and the fonts of texts, whose paths are relative to `folder`.
    pub fn with_designs<'a>(
        self,
        folder: &Path,
        designs: impl IntoIterator<Item = &'a Path>,
    ) -> Self {
        let sources = designs
            .into_iter()
            .map(|path| DesignSource::in_folder(folder, path));
        sources.fold(self, |files, source| match source.file() {
            Some(file) => files.with_file(file),
            None => files,
        })
    }

    /// Checks that no output is one of these files, even through a link or another spelling of its
    /// path.
    ///
    /// # Errors
    /// [`CliError::Usage`] names the output and the input.
    pub fn check_outputs(
        &self,
        outputs: impl IntoIterator<Item = impl AsRef<Path>>,
    ) -> Result<(), CliError> {
        for output in outputs {
            let output = output.as_ref();
            let Some(id) = FileId::of(output) else {
                continue;
            };
            if let Some((input, _)) = self.0.iter().find(|(_, input)| *input == id) {
                return Err(CliError::Usage(format!(
                    "writing `{}` would replace the input `{}`; choose another name for the output",
                    output.display(),
                    input.display()
                )));
            }
        }
        Ok(())
    }
}

//! A document together with the designs it names.

use super::document::{DesignEntry, Project};
use super::error::ProjectError;
use super::segment_features::strung;
use super::title::title_of;
use crate::content::ContentKind;
use crate::correspondence::MatchSettings;
use crate::design::{Design, DesignForm, DesignSource};
use crate::geometry::Similarity;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;
use crate::space::{DesignSpace, SpaceSpec, WeightMap};
use crate::transition::{
    BuildError, BuildQuality, PartTime, Transition, TransitionMethod, TransitionOptions,
    TransitionSpec, UnsupportedMethod, frame_similarity, place_in_frame,
};
use crate::warp::{ManyFeatures, WarpKind};
use crate::work::progress::{Progress, WholeProgress as WholeWork};
use include_dir::{Dir, File, include_dir};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The files of the gallery, held in the binary.
pub(super) static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// The content of a bundled file, by its path in a bundled document.
#[must_use]
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.get_file(path).map(File::contents)
}

/// What is said where many designs are asked to be blended as only two can be.
const NO_SPACE: &str = "many designs are blended as rigid parts or as fields at rest, and pictures at rest or by \
     lines, points or a lattice; choose one of these";

/// A project whose designs have been read.
#[derive(Clone, Debug)]
pub struct LoadedProject {
    /// The document.
    pub project: Project,
    /// The designs as their files give them, in the document's order.
    pub designs: Vec<Arc<Design>>,
    /// What relative paths are relative to; `None` for a bundled project.
    pub folder: Option<PathBuf>,
    /// Whether what takes very long is begun all the same; see
    /// [`crate::work::budget`].
    pub patient: bool,
    /// Where this is a leg of a sequence: all its designs.
    whole: Option<Arc<WholeSource>>,
    /// Where this is a leg of a path over the map: its number.
    path_leg: Option<usize>,
    /// The spaces that were built of it last, the newest first.
    spaces: Arc<Mutex<Vec<(SpaceSpec, DesignSpace)>>>,
}

/// Spaces that are remembered: a draft and the best, as rigid parts and as fields.
const SPACES: usize = 4;

/// What is said where a path is asked for what only two designs have.
const NO_PAIR: &str = "this is of two designs, and a path over the map goes between all of them: take the path away first";

/// Whether as many designs as one likes can be blended like that.
fn is_of_many(cell: TransitionMethod) -> bool {
    match cell.content() {
        ContentKind::Solid => cell.warp() == WarpKind::Arap,
        ContentKind::Field => cell.warp() == WarpKind::None,
        ContentKind::Colours => cell.warp() != WarpKind::Arap,
    }
}

/// What a leg has of the sequence that it belongs to.
#[derive(Debug)]
struct WholeSource {
    designs: Vec<Arc<Design>>,
    places: Vec<Similarity>,
}

impl LoadedProject {
    /// Reads a `.morph` file and its designs.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn open(path: &Path) -> Result<Self, ProjectError> {
        let project = Project::read(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self::load(project, Some(folder))
    }

    /// Whether this is one of several legs.
    #[must_use]
    pub fn is_leg(&self) -> bool {
        self.whole.is_some() || self.path_leg.is_some()
    }

    /// The number of the leg of a path over the map that this is.
    #[must_use]
    pub fn path_leg(&self) -> Option<usize> {
        self.path_leg
    }

    /// The name of the design at each whole t: that of the first once more at the end, where
    /// the last one leads back to it. Of a path the names of its stops.
    #[must_use]
    pub fn names_on_the_way(&self) -> Vec<&str> {
        if self.project.follows_path() {
            let stops = self.project.map.path.stops();
            let stops = stops.map(|(_, stop)| stop.name.as_str());
            return match self.path_leg {
                Some(leg) => stops.skip(leg).take(2).collect(),
                None => stops.collect(),
            };
        }
        let legs = self.project.leg_count();
        let designs = self.designs.iter().cycle().take(legs + 1);
        designs.map(|design| design.name.as_str()).collect()
    }

    /// The legs of a sequence as projects of two designs each; of a pair itself; of a path
    /// over the map each with all designs.
    #[must_use]
    pub fn legs(&self) -> Vec<Self> {
        if self.project.follows_path() {
            let leg = |leg: usize| Self {
                path_leg: Some(leg),
                ..self.clone()
            };
            return (0..self.project.leg_count()).map(leg).collect();
        }
        if !self.project.is_sequence() {
            return vec![self.clone()];
        }
        let whole = Arc::new(WholeSource {
            designs: self.designs.clone(),
            places: self
                .project
                .designs
                .iter()
                .map(|entry| entry.placement)
                .collect(),
        });
        let leg = |leg: usize| {
            let designs = self.project.leg_designs(leg);
            Self {
                project: self.project.leg(leg),
                designs: designs.map(|k| Arc::clone(&self.designs[k])).to_vec(),
                folder: self.folder.clone(),
                patient: self.patient,
                whole: Some(Arc::clone(&whole)),
                path_leg: None,
                spaces: Arc::default(),
            }
        };
        (0..self.project.leg_count()).map(leg).collect()
    }

    /// Reads two designs into a project with default options.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place.
    pub fn open_pair(source: &Path, target: &Path) -> Result<Self, ProjectError> {
        Self::load(Project::pair(source, target), Some(PathBuf::new()))
    }

    /// Reads the designs of a document. Its paths are relative to `folder`, or
    /// where there is none to the gallery.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn load(project: Project, folder: Option<PathBuf>) -> Result<Self, ProjectError> {
        let read = |entry: &DesignEntry| named(entry, folder.as_deref());
        // Beside each other: large ones take a second each.
        let designs: Vec<_> = project.designs.par_iter().map(read).collect();
        let designs: Result<_, ProjectError> = designs.into_iter().collect();
        Ok(Self {
            designs: designs?,
            project,
            folder,
            patient: false,
            whole: None,
            path_leg: None,
            spaces: Arc::default(),
        })
    }

    /// The same designs with other settings, which name as many.
    #[must_use]
    pub fn with(&self, project: Project) -> Self {
        Self {
            project,
            ..self.clone()
        }
    }

    /// Reads the designs again, after the document has changed what they are
    /// or how they are read.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn reread(self) -> Result<Self, ProjectError> {
        let patient = self.patient;
        let read = Self::load(self.project, self.folder)?;
        Ok(Self { patient, ..read })
    }

    /// Reads the designs that are new in the document, or read otherwise, since it was `before`:
    /// then it had the designs that are here.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place.
    pub fn read_beside(self, before: &Project) -> Result<Self, ProjectError> {
        let known = before.designs.iter().zip(&self.designs);
        let known: Vec<_> = known.collect();
        let is_same = |a: &DesignEntry, b: &DesignEntry| {
            (&a.path, &a.name, &a.import) == (&b.path, &b.name, &b.import)
        };
        let read = |entry: &DesignEntry| {
            let found = known.iter().find(|(known, _)| is_same(known, entry));
            match found {
                Some((_, design)) => Ok(Arc::clone(design)),
                None => named(entry, self.folder.as_deref()),
            }
        };
        let designs: Result<_, ProjectError> = self.project.designs.iter().map(read).collect();
        Ok(Self {
            designs: designs?,
            ..self.clone()
        })
    }

    /// What the transition is called, in one line.
    #[must_use]
    pub fn title(&self) -> String {
        if self.project.title.is_empty() {
            let names: Vec<_> = self.designs.iter().map(|d| d.name.as_str()).collect();
            title_of(&names)
        } else {
            SanitizedLine(&self.project.title).to_string()
        }
    }

    /// The cell that is asked for, or that suits the designs best.
    ///
    /// # Errors
    /// [`UnsupportedMethod`] if warp and content do not go together.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn cell(&self) -> Result<TransitionMethod, UnsupportedMethod> {
        let default =
            TransitionSpec::new(Arc::clone(&self.designs[0]), Arc::clone(&self.designs[1])).cell;
        match (self.project.warp, self.project.content) {
            (None, None) => Ok(default),
            (Some(warp), Some(content)) => TransitionMethod::new(warp, content),
            (Some(warp), None) => {
                let photographs = default.content() == ContentKind::Colours;
                let suits = |cell: &TransitionMethod| {
                    (cell.content() == ContentKind::Colours) == photographs
                };
                let cells = TransitionMethod::all().filter(|cell| cell.warp() == warp);
                // The first that suits, or the first of all.
                let found = cells.min_by_key(|cell| !suits(cell));
                Ok(found.unwrap_or(default))
            }
            (None, Some(content)) => {
                let mut cells = TransitionMethod::all().filter(|cell| cell.content() == content);
                let found = match content {
                    // Without pins the plane stands still.
                    ContentKind::Field | ContentKind::Colours => cells.last(),
                    ContentKind::Solid => cells.next(),
                };
                Ok(found.unwrap_or(default))
            }
        }
    }

    /// Whether these designs can be seen by a cell, without building it.
    ///
    /// # Errors
    /// [`BuildError`] with the reason, for a greyed button.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn available(&self, warp: WarpKind, content: ContentKind) -> Result<(), BuildError> {
        let cell = TransitionMethod::new(warp, content)?;
        if self.path_leg.is_some() && !is_of_many(cell) {
            return Err(BuildError::Unavailable(NO_SPACE.to_owned()));
        }
        TransitionSpec::available(cell, &self.designs[0], &self.designs[1])
    }

    /// What lays both designs into one frame.
    ///
    /// # Errors
    /// A placement that is no similarity.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn arrangement(&self) -> Result<[Similarity; 2], ProjectError> {
        let first = (self.first(), self.project.fit);
        let by =
            |k: usize| frame_similarity(&self.designs[k], first, self.project.designs[k].placement);
        Ok([by(0)?, by(1)?])
    }

    /// The design that all others are fitted to.
    fn first(&self) -> &Design {
        let whole = self
            .whole
            .as_ref()
            .map_or(&self.designs, |whole| &whole.designs);
        &whole[0]
    }

    /// The other designs of a sequence, as far as a leg's film depends on them.
    fn others(&self, cell: TransitionMethod) -> Result<Vec<Arc<Design>>, ProjectError> {
        let Some(whole) = &self.whole else {
            return Ok(Vec::new());
        };
        let has_bars = |design: &Arc<Design>| matches!(design.form, DesignForm::Truss(_));
        // Fields share a grid, bars a width; all else would be laid in vain.
        if cell.content() != ContentKind::Field && !whole.designs.iter().any(has_bars) {
            return Ok(Vec::new());
        }
        let first = (self.first(), self.project.fit);
        let laid = whole.designs.iter().zip(&whole.places);
        let laid = laid.map(|(design, place)| place_in_frame(design, first, *place));
        Ok(laid.collect::<Result<_, _>>()?)
    }

    /// What the space of all designs is to be built from.
    ///
    /// # Errors
    /// [`ProjectError`] if the cell does not exist, or has no blend of many, or a placement
    /// is no similarity.
    pub fn space(&self) -> Result<SpaceSpec, ProjectError> {
        let project = &self.project;
        let mut cell = self.cell().map_err(BuildError::from)?;
        let is_asked = project.warp.is_some() || project.content.is_some();
        if !is_asked && self.designs.iter().any(|design| design.picture.is_none()) {
            // The first two are photographs, others are not.
            cell = TransitionMethod::RIGID_PARTS;
        }
        if !is_of_many(cell) {
            return Err(BuildError::Unavailable(NO_SPACE.to_owned()).into());
        }
        let first = (self.first(), project.fit);
        let laid = self.designs.iter().zip(&project.designs);
        let laid = laid.map(|(design, entry)| place_in_frame(design, first, entry.placement));
        let mut spec = SpaceSpec {
            // As rigid parts where all have a common mesh.
            content: Some(cell.content()).filter(|content| *content != ContentKind::Solid),
            warp: cell.warp(),
            options: project.options.clone(),
            patient: self.patient,
            ..SpaceSpec::new(laid.collect::<Result<_, _>>()?)
        };
        if cell.content() == ContentKind::Colours && cell.warp() != WarpKind::None {
            (spec.features, spec.lone_features) = self.features()?;
        }
        Ok(spec)
    }

    /// What all designs have in common, laid into their frame, and how many features only
    /// some of them have.
    fn features(&self) -> Result<(ManyFeatures, usize), ProjectError> {
        let count = self.designs.len();
        let legs = (0..count.saturating_sub(1)).map(|leg| {
            let alone = self.project.pair_alone(leg);
            alone.options.matching
        });
        let legs: Vec<MatchSettings> = legs.collect();
        let diameters: Vec<f64> = self.designs.iter().map(|d| d.extent.diameter()).collect();
        let (mut features, lone) = strung(&legs, &diameters);
        let first = (self.first(), self.project.fit);
        for design in 0..count {
            let place = self.project.designs[design].placement;
            let by = frame_similarity(&self.designs[design], first, place)?;
            let points = features.points.iter_mut().map(|each| &mut each[design]);
            let ends = features.lines.iter_mut().flat_map(|each| &mut each[design]);
            points.chain(ends).for_each(|p| *p = by.apply(*p));
        }
        Ok((features, lone))
    }

    /// The space of all designs, of this quality or as the project asks for: built, or as it
    /// was built before.
    ///
    /// # Errors
    /// As [`Self::space`], and why the designs span none.
    pub fn built_space(
        &self,
        quality: Option<BuildQuality>,
        progress: &dyn Progress,
    ) -> Result<DesignSpace, ProjectError> {
        let mut spec = self.space()?;
        if let Some(quality) = quality {
            spec.options.quality = quality;
        }
        // Held while it is built: who asks for the same meanwhile waits for it.
        let mut known = self.spaces.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, space)) = known.iter().find(|(of, _)| *of == spec) {
            return Ok(space.clone());
        }
        let space = DesignSpace::build(&spec, progress)?;
        known.insert(0, (spec, space.clone()));
        known.truncate(SPACES);
        Ok(space)
    }

    /// The map of a space of these designs.
    ///
    /// # Errors
    /// Two designs are in one place.
    pub fn map_of(&self, space: &DesignSpace) -> Result<WeightMap, ProjectError> {
        let sites = self.project.map.sites(space.likeness());
        Ok(WeightMap::new(&sites).map_err(super::map::MapError::from)?)
    }

    /// Builds the transition: of a leg of a path from its space, of all else as
    /// [`Self::spec`] says.
    ///
    /// # Errors
    /// [`ProjectError`] says what does not go together.
    pub fn build(&self, progress: &dyn Progress) -> Result<Transition, ProjectError> {
        let Some(leg) = self.path_leg else {
            return Ok(Transition::build(&self.spec()?, progress)?);
        };
        let space = self.built_space(None, progress)?;
        let map = self.map_of(&space)?;
        let progress = &WholeWork::new(progress).patient(self.patient);
        Ok(space.leg((&map, &self.project.map.path), leg, progress)?)
    }

    /// The first film, where the one that is asked for takes longer: as
    /// [`TransitionSpec::draft`] has it. None where it is not sooner there, or cannot be had.
    #[must_use]
    pub fn draft(&self, progress: &dyn Progress) -> Option<(BuildQuality, Transition)> {
        if self.path_leg.is_none() {
            let spec = self.spec().ok()?.draft(progress)?;
            let built = Transition::build(&spec, progress).ok()?;
            return Some((spec.options.quality, built));
        }
        let is_outline = |design: &Arc<Design>| matches!(design.form, DesignForm::Outline(_));
        let is_sooner = self.space().ok()?.content.is_none()
            && self.project.options.quality != BuildQuality::Draft
            && self.designs.iter().any(is_outline);
        if !is_sooner {
            return None;
        }
        let mut project = self.project.clone();
        project.options.quality = BuildQuality::Draft;
        Some((
            BuildQuality::Draft,
            self.with(project).build(progress).ok()?,
        ))
    }

    /// What the transition is to be built from; of a sequence, that of its first leg.
    ///
    /// # Errors
    /// [`ProjectError`] if the cell does not exist or a placement is no
    /// similarity.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn spec(&self) -> Result<TransitionSpec, ProjectError> {
        if self.project.follows_path() {
            return Err(BuildError::Unavailable(NO_PAIR.to_owned()).into());
        }
        if self.project.is_sequence() {
            return self.legs()[0].spec();
        }
        let project = &self.project;
        let by = self.arrangement()?;
        let first = (self.first(), project.fit);
        let laid = |k: usize| place_in_frame(&self.designs[k], first, project.designs[k].placement);
        let cell = self.cell().map_err(BuildError::from)?;
        Ok(TransitionSpec {
            source: laid(0)?,
            target: laid(1)?,
            cell,
            others: self.others(cell)?,
            options: TransitionOptions {
                // Pins are written in the designs' own units, and matched where they are laid.
                matching: project.options.matching.placed(&by),
                parts: placed(&project.options.parts, &by),
                ..project.options.clone()
            },
            patient: self.patient,
            found: project.found.clone(),
        })
    }
}

fn placed(parts: &[PartTime], by: &[Similarity; 2]) -> Vec<PartTime> {
    parts.iter().map(|part| part.placed(by)).collect()
}

/// A design under the name that the document gives it, if any.
fn named(entry: &DesignEntry, folder: Option<&Path>) -> Result<Arc<Design>, ProjectError> {
    let mut design = read(entry, folder)?;
    if !entry.name.is_empty() {
        design.name = SanitizedLine(&entry.name).to_string();
    }
    Ok(Arc::new(design))
}

/// A design that a document in a folder names, or one of the gallery.
fn read(entry: &DesignEntry, folder: Option<&Path>) -> Result<Design, ProjectError> {
    let source = match folder {
        Some(folder) => DesignSource::in_folder(folder, &entry.path),
        // A bundled project whose design a user has replaced by a file.
        None if entry.path.is_absolute() => DesignSource::of(&entry.path),
        // The binary is its own file system: no path of it is one of the disk's.
        None => {
            let source = DesignSource::parse(&entry.path, |path| bytes(path).is_some());
            let missing = |file: &Path| ProjectError::from(ReadError::Missing).in_file(file);
            let bytes = match source.file() {
                Some(file) => bytes(file).ok_or_else(|| missing(file))?,
                None => &[],
            };
            return Ok(source.import_bytes(bytes, &entry.import)?);
        }
    };
    Ok(source.import(&entry.import)?)
}

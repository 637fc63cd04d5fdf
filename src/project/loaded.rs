//! A project together with its designs, and the building of its transitions and design space.

use super::document::{DesignEntry, Project};
use super::error::ProjectError;
use super::segment_features::features_in_all_designs;
use super::title::title_of;
use crate::colour::Rgb;
use crate::content::ContentKind;
use crate::correspondence::MatchSettings;
use crate::design::{Design, DesignForm, DesignSource};
use crate::geometry::Similarity;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedName;
use crate::space::{DesignSpace, SpaceNote, SpaceSpec, WeightMap};
use crate::transition::{
    BuildError, BuildQuality, PartTime, Transition, TransitionMethod, TransitionNote,
    TransitionOptions, TransitionSpec, TransitionStyle, UnsupportedMethod, frame_similarity,
    place_in_frame,
};
use crate::warp::{ManyFeatures, WarpKind};
use crate::work::progress::{OverallProgress, Progress};
use include_dir::{Dir, File, include_dir};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Files of the gallery, embedded in the binary.
pub(super) static FILES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/assets/gallery");

/// Returns the content of the gallery file with the given path, relative to the gallery as in
/// bundled projects; `None` if there is no such file.
#[must_use]
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.get_file(path).map(File::contents)
}

/// Error message if more than two designs are to be blended with a method for two designs.
const UNSUPPORTED_FOR_SPACE: &str = "three or more designs can be blended as rigid parts, as \
     distance fields without a warp, or as pictures (without a warp, or by lines, points or a \
     lattice); choose one of these";

/// A project whose designs have been read.
#[derive(Clone, Debug)]
pub struct LoadedProject {
    /// Contents of the project file.
    pub project: Project,
    /// Designs as imported, in the order of the project.
    pub designs: Vec<Arc<Design>>,
    /// Folder to which the paths of the designs are relative; `None` for a bundled project.
    pub folder: Option<PathBuf>,
    /// Hash of the project file as it was read or last saved, see [`Project::file_hash`]; `None` if
    /// there is no file.
    pub file_hash: Option<u64>,
    /// Whether jobs beyond the limits of [`crate::work::budget`] may start.
    pub patient: bool,
    /// All designs of the sequence, if this project is one of its segments.
    sequence: Option<Arc<SequenceSource>>,
    /// Index of the segment, if this project is one segment of a path over the map.
    path_segment: Option<usize>,
    /// The design spaces that were built last, each with its specification, the newest first.
    /// Shared by all clones.
    spaces: Arc<Mutex<Vec<(SpaceSpec, DesignSpace)>>>,
}

/// Maximum number of cached design spaces (resource limit: enough for draft and best quality, each
/// as rigid parts and as distance fields).
const MAX_CACHED_SPACES: usize = 4;

/// Error message if an operation needs a transition of two designs, but the film follows a path.
const PAIR_REQUIRED: &str = "this applies to two designs, but the film follows a path between \
     all of them; remove the path first";

/// Returns whether a method can blend any number of designs.
fn supports_spaces(method: TransitionMethod) -> bool {
    match method.content() {
        ContentKind::Solid => method.warp() == WarpKind::Arap,
        ContentKind::Field => method.warp() == WarpKind::None,
        ContentKind::Colours => method.warp() != WarpKind::Arap,
    }
}

/// Designs of the whole sequence to which a segment belongs, and the similarity transforms that the
/// project applies to them.
#[derive(Debug)]
struct SequenceSource {
    designs: Vec<Arc<Design>>,
    places: Vec<Similarity>,
}

impl LoadedProject {
    /// Reads a `.morph` file and its designs.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place in it.
    pub fn open(path: &Path) -> Result<Self, ProjectError> {
        let (project, file_hash) = Project::read_with_hash(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut loaded = Self::load(project, Some(folder))?;
        loaded.file_hash = Some(file_hash);
        Ok(loaded)
    }

    /// Returns whether this project is one segment of a sequence or of a path.
    #[must_use]
    pub fn is_segment(&self) -> bool {
        self.sequence.is_some() || self.path_segment.is_some()
    }

    /// Returns the index of the segment if this project is one segment of a path over the map.
    #[must_use]
    pub fn path_segment(&self) -> Option<usize> {
        self.path_segment
    }

    /// Returns the name shown at each whole t: the name of the design, or of the stop of a path.
    ///
    /// A closed sequence ends with the name of the first design.
    #[must_use]
    pub fn stop_names(&self) -> Vec<&str> {
        if self.project.follows_path() {
            let stops = self.project.map.path.stops();
            let stops = stops.map(|(_, stop)| stop.name.as_str());
            return match self.path_segment {
                Some(segment) => stops.skip(segment).take(2).collect(),
                None => stops.collect(),
            };
        }
        let segments = self.project.segment_count();
        let designs = self.designs.iter().cycle().take(segments + 1);
        designs.map(|design| design.name.as_str()).collect()
    }

    /// Returns the segments of the film as separate projects, each of two designs.
    ///
    /// A project of two designs is its own only segment. The segments of a path keep all designs.
    #[must_use]
    pub fn segments(&self) -> Vec<Self> {
        if self.project.follows_path() {
            let path_segment = |segment: usize| Self {
                path_segment: Some(segment),
                ..self.clone()
            };
            return (0..self.project.segment_count())
                .map(path_segment)
                .collect();
        }
        if !self.project.is_sequence() {
            return vec![self.clone()];
        }
        let sequence = Arc::new(SequenceSource {
            designs: self.designs.clone(),
            places: self
                .project
                .designs
                .iter()
                .map(|entry| entry.placement)
                .collect(),
        });
        let segment = |segment: usize| {
            let designs = self.project.segment_designs(segment);
            Self {
                project: self.project.segment(segment),
                designs: designs.map(|k| Arc::clone(&self.designs[k])).to_vec(),
                folder: self.folder.clone(),
                file_hash: None,
                patient: self.patient,
                sequence: Some(Arc::clone(&sequence)),
                path_segment: None,
                spaces: Arc::default(),
            }
        };
        (0..self.project.segment_count()).map(segment).collect()
    }

    /// Reads two designs into a project with default options.
    ///
    /// # Errors
    /// [`ProjectError::Import`] names the file and the place in it.
    pub fn open_pair(source: &Path, target: &Path) -> Result<Self, ProjectError> {
        Self::load(Project::from_pair(source, target), Some(PathBuf::new()))
    }

    /// Reads the designs of a project, whose paths are relative to `folder`.
    ///
    /// Without a folder, the designs are files of the gallery.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place in it.
    pub fn load(project: Project, folder: Option<PathBuf>) -> Result<Self, ProjectError> {
        let read = |entry: &DesignEntry| read_named(entry, folder.as_deref());
        // Read in parallel, because large designs take a second each.
        let designs: Vec<_> = project.designs.par_iter().map(read).collect();
        let designs: Result<_, ProjectError> = designs.into_iter().collect();
        Ok(Self {
            designs: designs?,
            project,
            folder,
            file_hash: None,
            patient: false,
            sequence: None,
            path_segment: None,
            spaces: Arc::default(),
        })
    }

    /// Returns the same designs with another project, which must list as many designs.
    #[must_use]
    pub fn with_project(&self, project: Project) -> Self {
        Self {
            project,
            ..self.clone()
        }
    }

    /// Reads all designs again, after changes of their paths or import options.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place in it.
    pub fn reread(self) -> Result<Self, ProjectError> {
        let patient = self.patient;
        let loaded = Self::load(self.project, self.folder)?;
        Ok(Self { patient, ..loaded })
    }

    /// Reads each design for which `before` has no design with the same path, name and import
    /// options. The other designs are reused.
    ///
    /// `before` must be the project to which the currently loaded designs belong.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and the place in it.
    pub fn reread_changed(self, before: &Project) -> Result<Self, ProjectError> {
        let previous: Vec<_> = before.designs.iter().zip(&self.designs).collect();
        let is_same = |a: &DesignEntry, b: &DesignEntry| {
            (&a.path, &a.name, &a.import) == (&b.path, &b.name, &b.import)
        };
        let read = |entry: &DesignEntry| {
            let unchanged = previous.iter().find(|(old, _)| is_same(old, entry));
            match unchanged {
                Some((_, design)) => Ok(Arc::clone(design)),
                None => read_named(entry, self.folder.as_deref()),
            }
        };
        let designs: Result<_, ProjectError> = self.project.designs.iter().map(read).collect();
        Ok(Self {
            designs: designs?,
            ..self.clone()
        })
    }

    /// Returns the title of the project in one line; without a title, one made from the designs'
    /// names.
    #[must_use]
    pub fn title(&self) -> String {
        if self.project.title.is_empty() {
            let names: Vec<_> = self.designs.iter().map(|d| d.name.as_str()).collect();
            title_of(&names)
        } else {
            SanitizedName(&self.project.title).to_string()
        }
    }

    /// Returns the colours in which other programs show the first and the last design, if all
    /// designs are drawings that name no colour, such as black icons.
    #[must_use]
    pub fn drawn_colours(&self) -> Option<[Rgb; 2]> {
        let colours = self.designs.iter().map(|design| design.drawn_colour);
        let colours: Option<Vec<Rgb>> = colours.collect();
        let colours = colours?;
        Some([*colours.first()?, *colours.last()?])
    }

    /// Gives a new project the colours in which its designs are drawn, unless others were chosen.
    pub fn adopt_drawn_colours(&mut self) {
        let plain = TransitionStyle::default();
        let style = &self.project.style;
        let is_chosen = (style.source, style.target) != (plain.source, plain.target);
        if let Some([source, target]) = self.drawn_colours().filter(|_| !is_chosen) {
            let style = &mut self.project.style;
            (style.source, style.target) = (source, target);
        }
    }

    /// Returns the method of the transition: the requested warp and content, or what suits the
    /// designs best if one of them or both are not requested.
    ///
    /// # Errors
    /// [`UnsupportedMethod`] if warp and content cannot be combined.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn method(&self) -> Result<TransitionMethod, UnsupportedMethod> {
        let default =
            TransitionSpec::new(Arc::clone(&self.designs[0]), Arc::clone(&self.designs[1])).method;
        match (self.project.warp, self.project.content) {
            (None, None) => Ok(default),
            (Some(warp), Some(content)) => TransitionMethod::new(warp, content),
            (Some(warp), None) => {
                let are_pictures = default.content() == ContentKind::Colours;
                let suits = |method: &TransitionMethod| {
                    (method.content() == ContentKind::Colours) == are_pictures
                };
                let methods = TransitionMethod::all().filter(|method| method.warp() == warp);
                // The first method with this warp whose content suits the designs; if none does,
                // the first method with this warp.
                let chosen = methods.min_by_key(|method| !suits(method));
                Ok(chosen.unwrap_or(default))
            }
            (None, Some(content)) => {
                let mut methods =
                    TransitionMethod::all().filter(|method| method.content() == content);
                let chosen = match content {
                    // The last of these methods has no warp. The others may need pins or lines, so
                    // they are not chosen by default.
                    ContentKind::Field | ContentKind::Colours => methods.last(),
                    ContentKind::Solid => methods.next(),
                };
                Ok(chosen.unwrap_or(default))
            }
        }
    }

    /// Checks whether a method is available for these designs, without building it.
    ///
    /// # Errors
    /// [`BuildError`] with the reason, for the tooltip of a disabled button.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn check_available(&self, warp: WarpKind, content: ContentKind) -> Result<(), BuildError> {
        let method = TransitionMethod::new(warp, content)?;
        if self.path_segment.is_some() && !supports_spaces(method) {
            return Err(BuildError::Unavailable(UNSUPPORTED_FOR_SPACE.to_owned()));
        }
        TransitionSpec::available(method, &self.designs[0], &self.designs[1])
    }

    /// Returns the similarity transforms of the first two designs, from the coordinates of each
    /// design to the common coordinates of all designs.
    ///
    /// # Errors
    /// [`ProjectError`] if the placement of a design is not a valid similarity transform.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn frame_similarities(&self) -> Result<[Similarity; 2], ProjectError> {
        let (reference, fit) = (self.reference_design(), self.project.fit);
        let similarity = |k: usize| {
            let place = self.project.designs[k].placement;
            frame_similarity(&self.designs[k], reference, fit, place)
        };
        Ok([similarity(0)?, similarity(1)?])
    }

    /// Returns the design to which all others are aligned.
    fn reference_design(&self) -> &Design {
        let designs = self
            .sequence
            .as_ref()
            .map_or(&self.designs, |sequence| &sequence.designs);
        &designs[0]
    }

    /// Returns all designs of the sequence if the film of this segment depends on them; otherwise
    /// none.
    fn sequence_designs(&self, method: TransitionMethod) -> Result<Vec<Arc<Design>>, ProjectError> {
        let Some(sequence) = &self.sequence else {
            return Ok(Vec::new());
        };
        let has_bars = |design: &Arc<Design>| matches!(design.form, DesignForm::Truss(_));
        // In a sequence, all distance fields share a grid and all bars a width; nothing else is
        // shared.
        if method.content() != ContentKind::Field && !sequence.designs.iter().any(has_bars) {
            return Ok(Vec::new());
        }
        let (reference, fit) = (self.reference_design(), self.project.fit);
        let entries = sequence.designs.iter().zip(&sequence.places);
        let placed = entries.map(|(design, place)| place_in_frame(design, reference, fit, *place));
        Ok(placed.collect::<Result<_, _>>()?)
    }

    /// Returns the specification from which [`Self::build_space`] builds the design space: all
    /// designs of the project, in common coordinates, with the content, warp and options.
    ///
    /// # Errors
    /// [`ProjectError`] if the method does not exist or cannot blend several designs, or if the
    /// placement of a design is not a valid similarity transform.
    pub fn space_spec(&self) -> Result<SpaceSpec, ProjectError> {
        let project = &self.project;
        let mut method = self.method().map_err(BuildError::from)?;
        let is_requested = project.warp.is_some() || project.content.is_some();
        if !is_requested && self.designs.iter().any(|design| design.picture.is_none()) {
            // The default method depends only on the first two designs, so it may be one for
            // pictures. Here at least one design is not a picture.
            method = TransitionMethod::RIGID_PARTS;
        }
        if !supports_spaces(method) {
            return Err(BuildError::Unavailable(UNSUPPORTED_FOR_SPACE.to_owned()).into());
        }
        let (reference, fit) = (self.reference_design(), project.fit);
        let entries = self.designs.iter().zip(&project.designs);
        let placed =
            entries.map(|(design, entry)| place_in_frame(design, reference, fit, entry.placement));
        let fitted_pages = self.designs.iter();
        let fitted_pages = fitted_pages.filter_map(|design| fit.fitted_page(design, reference));
        let mut spec = SpaceSpec {
            notes: fitted_pages.map(SpaceNote::PageFitted).collect(),
            // `None` lets designs without a common mesh fall back to distance fields.
            content: Some(method.content()).filter(|content| *content != ContentKind::Solid),
            warp: method.warp(),
            options: project.options.clone(),
            patient: self.patient,
            ..SpaceSpec::new(placed.collect::<Result<_, _>>()?)
        };
        if method.content() == ContentKind::Colours && method.warp() != WarpKind::None {
            (spec.features, spec.unmatched_features) = self.features()?;
        }
        Ok(spec)
    }

    /// Returns the features (pins and lines) that exist in all designs, at their positions in the
    /// common coordinates of all designs, and the number of features that exist in only some
    /// designs.
    fn features(&self) -> Result<(ManyFeatures, usize), ProjectError> {
        let count = self.designs.len();
        let segments = (0..count.saturating_sub(1)).map(|pair| {
            let project = self.project.pair_project(pair);
            project.options.matching
        });
        let segments: Vec<MatchSettings> = segments.collect();
        let diameters: Vec<f64> = self.designs.iter().map(|d| d.extent.diameter()).collect();
        let (mut features, unmatched) = features_in_all_designs(&segments, &diameters);
        let (reference, fit) = (self.reference_design(), self.project.fit);
        for design in 0..count {
            let place = self.project.designs[design].placement;
            let similarity = frame_similarity(&self.designs[design], reference, fit, place)?;
            let points = features.points.iter_mut().map(|each| &mut each[design]);
            let ends = features.lines.iter_mut().flat_map(|each| &mut each[design]);
            points.chain(ends).for_each(|p| *p = similarity.apply(*p));
        }
        Ok((features, unmatched))
    }

    /// Builds the space of all designs, or returns a cached one.
    ///
    /// If `quality` is given, it overrides the quality of the project.
    ///
    /// # Errors
    /// As [`Self::space_spec`] and [`DesignSpace::build`].
    pub fn build_space(
        &self,
        quality: Option<BuildQuality>,
        progress: &dyn Progress,
    ) -> Result<DesignSpace, ProjectError> {
        let mut spec = self.space_spec()?;
        if let Some(quality) = quality {
            spec.options.quality = quality;
        }
        // The list stays locked while a space is built, so that a second request for the same space
        // waits for the first.
        let mut cached = self.spaces.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, space)) = cached.iter().find(|(cached_spec, _)| *cached_spec == spec) {
            return Ok(space.clone());
        }
        let space = DesignSpace::build(&spec, progress)?;
        cached.insert(0, (spec, space.clone()));
        cached.truncate(MAX_CACHED_SPACES);
        Ok(space)
    }

    /// Returns the map of a space of these designs.
    ///
    /// # Errors
    /// [`ProjectError`] if two sites coincide.
    pub fn map_of(&self, space: &DesignSpace) -> Result<WeightMap, ProjectError> {
        let sites = self.project.map.sites(space.distances());
        Ok(WeightMap::new(&sites).map_err(super::map::MapError::from)?)
    }

    /// Builds the transition that [`Self::spec`] specifies. For a segment of a path, builds the
    /// design space and the transition between the two stops instead.
    ///
    /// # Errors
    /// [`ProjectError`] says why the designs are incompatible, or that the work was cancelled.
    pub fn build(&self, progress: &dyn Progress) -> Result<Transition, ProjectError> {
        let Some(segment) = self.path_segment else {
            return Ok(Transition::build(&self.spec()?, progress)?);
        };
        let space = self.build_space(None, progress)?;
        let map = self.map_of(&space)?;
        let progress = &OverallProgress::new(progress).patient(self.patient);
        Ok(space.segment(&map, &self.project.map.path, segment, progress)?)
    }

    /// Builds a draft of the transition, to be shown until the requested quality is ready.
    ///
    /// Returns `None` if a draft would not be faster, see [`TransitionSpec::draft`], or cannot be
    /// built.
    #[must_use]
    pub fn draft(&self, progress: &dyn Progress) -> Option<(BuildQuality, Transition)> {
        if self.path_segment.is_none() {
            let spec = self.spec().ok()?.draft(progress)?;
            let built = Transition::build(&spec, progress).ok()?;
            return Some((spec.options.quality, built));
        }
        let is_outline = |design: &Arc<Design>| matches!(design.form, DesignForm::Outline(_));
        let is_faster = self.space_spec().ok()?.content.is_none()
            && self.project.options.quality != BuildQuality::Draft
            && self.designs.iter().any(is_outline);
        if !is_faster {
            return None;
        }
        let mut project = self.project.clone();
        project.options.quality = BuildQuality::Draft;
        Some((
            BuildQuality::Draft,
            self.with_project(project).build(progress).ok()?,
        ))
    }

    /// Returns the specification of the transition; for a sequence, that of its first segment.
    ///
    /// # Errors
    /// [`ProjectError`] if the method does not exist, the placement of a design is not a valid
    /// similarity transform, or the film follows a path.
    ///
    /// # Panics
    /// If there are fewer than two designs.
    pub fn spec(&self) -> Result<TransitionSpec, ProjectError> {
        if self.project.follows_path() {
            return Err(BuildError::Unavailable(PAIR_REQUIRED.to_owned()).into());
        }
        if self.project.is_sequence() {
            return self.segments()[0].spec();
        }
        let project = &self.project;
        let similarities = self.frame_similarities()?;
        let (reference, fit) = (self.reference_design(), project.fit);
        let placed_design = |k: usize| {
            let place = project.designs[k].placement;
            place_in_frame(&self.designs[k], reference, fit, place)
        };
        let method = self.method().map_err(BuildError::from)?;
        Ok(TransitionSpec {
            source: placed_design(0)?,
            target: placed_design(1)?,
            method,
            others: self.sequence_designs(method)?,
            notes: [0, 1]
                .into_iter()
                .filter_map(|k| fit.fitted_page(&self.designs[k], reference))
                .map(TransitionNote::PageFitted)
                .collect(),
            options: TransitionOptions {
                // Pins are stored in the designs' own coordinates, but matched in the common
                // coordinates.
                matching: project.options.matching.placed(&similarities),
                parts: placed_part_times(&project.options.parts, &similarities),
                ..project.options.clone()
            },
            patient: self.patient,
            cached_match: project.found.clone(),
        })
    }
}

fn placed_part_times(parts: &[PartTime], similarities: &[Similarity; 2]) -> Vec<PartTime> {
    parts.iter().map(|part| part.placed(similarities)).collect()
}

/// Reads a design and gives it the name from the project, if there is one.
fn read_named(entry: &DesignEntry, folder: Option<&Path>) -> Result<Arc<Design>, ProjectError> {
    let mut design = read(entry, folder)?;
    let name = SanitizedName(&entry.name).to_string();
    if !name.trim().is_empty() {
        design.name = name;
    }
    Ok(Arc::new(design))
}

/// Reads a design. Its path is relative to `folder`; without a folder, the path leads to a file of
/// the gallery.
fn read(entry: &DesignEntry, folder: Option<&Path>) -> Result<Design, ProjectError> {
    let source = match folder {
        Some(folder) => DesignSource::in_folder(folder, &entry.path),
        // The user has replaced a design of a bundled project by a file.
        None if entry.path.is_absolute() => DesignSource::from_path(&entry.path),
        // Other paths of a bundled project refer to embedded files, never to the disk.
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

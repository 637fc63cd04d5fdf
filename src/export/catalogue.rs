//! Exports the blends that were saved on a map of designs: one SVG and (if it has outlines) one DXF
//! per blend, an overview sheet (`catalogue.png`), and a table of measures (`catalogue.csv`).

use std::path::{Path, PathBuf};

use super::contact_sheet::SheetLayout;
use super::drawing::Drawing;
use super::error::ExportError;
use super::labels::text_colour_on;
use super::size::PixelSize;
use super::still::{encode_still, write_atomically};
use super::target::StillKind;
use super::view::PlaneView;
use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::io::escape::csv_line;
use crate::io::file_name::safe_file_name;
use crate::io::sanitize::SanitizedName;
use crate::measure::{BlendMeasures, BlendSampler};
use crate::project::SavedBlend;
use crate::settings::named;
use crate::space::{DesignSpace, WeightMap};
use crate::transition::TransitionStyle;
use crate::work::progress::{Progress, checkpoint};

/// Longer side of the image of one blend, in pixels (heuristic).
const LONGER_SIDE_PX: u32 = 960;

/// Formats in which each blend is written.
const DRAWINGS: [StillKind; 2] = [StillKind::Svg, StillKind::Dxf];

/// File name of the overview sheet.
const SHEET: &str = "catalogue.png";

/// File name of the table of measures.
const TABLE: &str = "catalogue.csv";

/// Order in which saved blends are listed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CatalogueOrder {
    /// In the order in which the blends were saved.
    #[default]
    Saved,
    /// Most stars first.
    Stars,
    /// Alphabetically by name.
    Name,
    /// Smallest area first.
    Area,
    /// Shortest outline first.
    Perimeter,
    /// Least distorted first.
    Distortion,
}

named! { CatalogueOrder {
    Saved: "kept", "As saved", "In the order in which they were saved";
    Stars: "stars", "Stars", "Highest rating first";
    Name: "name", "Name", "Alphabetically by name";
    Area: "area", "Area", "Smallest area first";
    Perimeter: "perimeter", "Perimeter", "Shortest outline first";
    Distortion: "distortion", "Distortion", "Least distorted first";
} }

/// Saved blends with their measures, filtered and sorted.
#[derive(Clone, Debug)]
pub struct Catalogue {
    entries: Vec<CatalogueEntry>,
}

/// One saved blend with its weights and measures.
#[derive(Clone, Debug)]
struct CatalogueEntry {
    saved: SavedBlend,
    weights: Vec<f64>,
    measures: BlendMeasures,
}

impl Catalogue {
    /// Selects the blends with at least `min_stars` stars and sorts them; ties keep the order in
    /// which they were saved. A blend without a name is named after its designs with the largest
    /// weights.
    ///
    /// # Panics
    /// If the map does not have one site per design of the space.
    #[must_use]
    pub fn new(
        space: &DesignSpace,
        map: &WeightMap,
        saved: &[SavedBlend],
        min_stars: u8,
        order: CatalogueOrder,
    ) -> Self {
        let mut sampler = BlendSampler::of(space);
        let entry = |saved: &SavedBlend| {
            let mut weights = vec![0.0; space.designs().len()];
            map.weights(saved.at, &mut weights);
            let mut saved = saved.clone();
            if saved.name.is_empty() {
                saved.name = space.blend_label(&weights);
            }
            CatalogueEntry {
                measures: sampler.measure(&weights),
                weights,
                saved,
            }
        };
        let selected = saved.iter().filter(|saved| saved.stars >= min_stars);
        let mut entries: Vec<CatalogueEntry> = selected.map(entry).collect();
        let distortion =
            |entry: &CatalogueEntry| entry.measures.quality.conformal_p95.unwrap_or(1.0);
        entries.sort_by(|a, b| match order {
            CatalogueOrder::Saved => std::cmp::Ordering::Equal,
            CatalogueOrder::Stars => b.saved.stars.cmp(&a.saved.stars),
            CatalogueOrder::Name => a.saved.name.cmp(&b.saved.name),
            CatalogueOrder::Area => a.measures.area.total_cmp(&b.measures.area),
            CatalogueOrder::Perimeter => a.measures.perimeter.total_cmp(&b.measures.perimeter),
            CatalogueOrder::Distortion => distortion(a).total_cmp(&distortion(b)),
        });
        Self { entries }
    }

    /// Returns the number of selected blends.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether no blend was selected.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns the paths of all files that [`Self::write`] may write into a folder.
    #[must_use]
    pub fn paths(&self, folder: &Path) -> Vec<PathBuf> {
        let path = |k: usize, kind| folder.join(drawing_name(k, &self.entries[k].saved, kind));
        let drawings = (0..self.len()).flat_map(|k| DRAWINGS.map(|kind| path(k, kind)));
        drawings
            .chain([SHEET, TABLE].map(|name| folder.join(name)))
            .collect()
    }

    /// Writes all files into a folder and returns their paths. The folder is created if missing;
    /// existing files with the same names are overwritten.
    ///
    /// # Errors
    /// [`ExportError`] naming the file that cannot be written. Files written before it are
    /// complete.
    pub fn write(
        &self,
        space: &DesignSpace,
        style: &TransitionStyle,
        ground: Option<Rgb>,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<Vec<PathBuf>, ExportError> {
        std::fs::create_dir_all(folder).map_err(ExportError::write(folder))?;
        let bounds = space.bounds();
        let bounds = bounds.padded(0.04 * bounds.diameter());
        let view = PlaneView::fit(bounds, PixelSize::of_shape(bounds, LONGER_SIDE_PX));
        let mut written = Vec::new();
        for (k, entry) in self.entries.iter().enumerate() {
            checkpoint(progress, "writing", k as f64 / self.len() as f64)?;
            let mut drawing = Drawing::new(view.size(), ground);
            self.draw(space, k, style, &view, &mut drawing);
            for kind in DRAWINGS {
                let path = folder.join(drawing_name(k, &entry.saved, kind));
                match encode_still(&drawing, kind, &path) {
                    Ok(bytes) => {
                        write_atomically(&path, &bytes)?;
                        written.push(path);
                    }
                    // Some blends of distance fields have no outline, so they cannot be written as
                    // DXF.
                    Err(ExportError::NoOutlines) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        let sheet = folder.join(SHEET);
        let drawing = self.sheet(space, style, ground);
        write_atomically(&sheet, &encode_still(&drawing, StillKind::Png, &sheet)?)?;
        let table = folder.join(TABLE);
        write_atomically(&table, &self.table(space))?;
        written.extend([sheet, table]);
        Ok(written)
    }

    /// Draws all selected blends side by side, with their names and stars.
    #[must_use]
    pub fn sheet(
        &self,
        space: &DesignSpace,
        style: &TransitionStyle,
        ground: Option<Rgb>,
    ) -> Drawing {
        // Automatic names are long, so cells that are higher than wide are widened to squares.
        let bounds = space.bounds();
        let padding = 0.5 * (bounds.size().y - bounds.size().x).max(0.0) * DVec2::X;
        let bounds = Bounds {
            min: bounds.min - padding,
            max: bounds.max + padding,
        };
        let layout = SheetLayout::new(self.len().max(1), bounds, None);
        let mut drawing = Drawing::new(layout.size, ground);
        for (k, entry) in self.entries.iter().enumerate() {
            let (corner, inner, base) = layout.cell(k);
            let view = PlaneView::fit_cell(bounds, layout.size, corner, inner);
            self.draw(space, k, style, &view, &mut drawing);
            let words = match entry.saved.stars {
                0 => SanitizedName(&entry.saved.name).to_string(),
                stars => format!("{}, {stars} of 5", SanitizedName(&entry.saved.name)),
            };
            let [width, height] = layout.label_room(inner);
            let room = [width, 0.8 * height];
            drawing.push_label_within(&words, base, room, text_colour_on(ground));
        }
        drawing
    }

    /// Returns the drawing of the selected blend with index `k`.
    fn draw(
        &self,
        space: &DesignSpace,
        k: usize,
        style: &TransitionStyle,
        view: &PlaneView,
        drawing: &mut Drawing,
    ) {
        let weights = &self.entries[k].weights;
        let mut frame = space.frame();
        frame.seek(weights);
        drawing.push_blend(&frame, style, view);
    }

    /// Returns the CSV table: one row per blend, with a column of weights for each design.
    fn table(&self, space: &DesignSpace) -> Vec<u8> {
        let place_header = ["file", "name", "stars", "note", "x", "y"].map(str::to_owned);
        let designs = space.designs().iter();
        let weights_header =
            designs.map(|design| format!("weight of {}", SanitizedName(&design.name)));
        let measures_header = [
            "area",
            "perimeter",
            "conformal_p95",
            "travel",
            "folds",
            "crossings",
        ];
        let header = place_header
            .into_iter()
            .chain(weights_header)
            .chain(measures_header.map(str::to_owned));
        let mut table = csv_line(header);
        for (k, entry) in self.entries.iter().enumerate() {
            let CatalogueEntry {
                saved, measures, ..
            } = entry;
            let number = |value: f64| value.to_string();
            let number_or_empty = |value: Option<f64>| value.map_or_else(String::new, number);
            let place_cells = [
                stem(k, saved),
                SanitizedName(&saved.name).to_string(),
                saved.stars.to_string(),
                SanitizedName(&saved.note).to_string(),
                number(saved.at.x),
                number(saved.at.y),
            ];
            let weights = entry.weights.iter().copied().map(number);
            let measure_cells = [
                number(measures.area),
                number(measures.perimeter),
                number_or_empty(measures.quality.conformal_p95),
                number_or_empty(measures.travel),
                measures.quality.folds.to_string(),
                measures.quality.crossings.to_string(),
            ];
            let row = place_cells.into_iter().chain(weights).chain(measure_cells);
            table.extend(csv_line(row));
        }
        table
    }
}

/// Returns the file name of a blend in a format.
fn drawing_name(k: usize, saved: &SavedBlend, kind: StillKind) -> String {
    format!("{}.{kind}", stem(k, saved))
}

/// Returns the file name of a blend, without extension: its number, which makes the name unique,
/// and the words of its name without spaces and punctuation.
fn stem(k: usize, saved: &SavedBlend) -> String {
    let name = safe_file_name(&saved.name);
    let words: Vec<&str> = name
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    format!("{:02}-{}", k + 1, words.join("-"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::export::drawing::DrawingItem;
    use crate::export::outline::PathCommand;
    use crate::space::{MapLayout, SpaceSpec};
    use crate::work::progress::Silent;
    use std::sync::Arc;

    fn space() -> (DesignSpace, WeightMap) {
        let tent = |name: &str, h: f64| {
            let ring = [[0.0, 0.0], [2.0, 0.0], [1.0, h]];
            Arc::new(Design::from_rings(name, [ring]).expect("a design"))
        };
        let designs = vec![tent("low", 1.0), tent("high", 2.0), tent("tower", 4.0)];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances())).expect("sites");
        (space, map)
    }

    fn saved(map: &WeightMap) -> Vec<SavedBlend> {
        let place = |site: DVec2, name: &str, stars: u8| SavedBlend {
            name: name.to_owned(),
            stars,
            ..SavedBlend::new(site)
        };
        vec![
            place(map.sites()[2], "a/b", 2),
            place(map.sites()[0], "", 5),
            place(DVec2::ZERO, "a/b", 0),
        ]
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn all_saved_places_are_written_and_measured() {
        let (space, map) = space();
        let saved = saved(&map);
        let folder = tempfile::tempdir().expect("a folder");
        let to = folder.path().join("new/catalogue");
        let catalogue = Catalogue::new(&space, &map, &saved, 0, CatalogueOrder::Area);
        let written = catalogue
            .write(&space, &TransitionStyle::default(), None, &to, &Silent)
            .expect("files");
        assert_eq!(written.len(), 3 * 2 + 2);
        assert!(written.iter().all(|path| path.exists()));
        let table = std::fs::read_to_string(to.join("catalogue.csv")).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[0].contains("weight of high") && lines[1].starts_with("01-low,low,5,"));
        assert!(lines[3].starts_with("03-a-b,a/b,2,"), "{}", lines[3]);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn places_can_be_filtered_by_stars() {
        let (space, map) = space();
        let all = Catalogue::new(&space, &map, &saved(&map), 1, CatalogueOrder::Stars);
        let stars = all.entries.iter().map(|entry| entry.saved.stars);
        assert_eq!(stars.collect::<Vec<_>>(), [5, 2]);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn long_names_stay_within_their_cells() {
        let (space, map) = space();
        let long = |site: DVec2| SavedBlend {
            name: "a name that says of which designs it is how much".to_owned(),
            ..SavedBlend::new(site)
        };
        let saved: Vec<SavedBlend> = map.sites().iter().map(|site| long(*site)).collect();
        let catalogue = Catalogue::new(&space, &map, &saved, 0, CatalogueOrder::Saved);
        let sheet = catalogue.sheet(&space, &TransitionStyle::default(), None);
        let spans = sheet.items.iter().filter_map(|item| match item {
            DrawingItem::Fill {
                outline,
                label: Some(_),
                ..
            } => {
                let xs = outline.commands.iter().filter_map(|step| match step {
                    PathCommand::Move(p) | PathCommand::Line(p) => Some(p.x),
                    _ => None,
                });
                Some([xs.clone().fold(f64::MAX, f64::min), xs.fold(0.0, f64::max)])
            }
            _ => None,
        });
        let spans: Vec<[f64; 2]> = spans.collect();
        assert_eq!(spans.len(), 3);
        assert!(spans[0][0] >= 0.0 && spans[2][1] <= f64::from(sheet.size.width()));
        assert!(
            spans.windows(2).all(|two| two[0][1] < two[1][0]),
            "{spans:?}"
        );
    }
}

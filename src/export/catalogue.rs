//! The places of a map that are kept, as files: each as SVG and, where it has outlines, as DXF;
//! all as a sheet, and their measures as a table.

use std::path::{Path, PathBuf};

use super::contact_sheet::SheetLayout;
use super::drawing::Drawing;
use super::error::ExportError;
use super::labels::text_colour_on;
use super::size::PixelSize;
use super::still::{encoded, write_atomically};
use super::target::StillKind;
use super::view::PlaneView;
use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2};
use crate::io::file_name::safe;
use crate::io::sanitize::SanitizedLine;
use crate::measure::{BlendMeasures, BlendSampler};
use crate::project::SavedPlace;
use crate::settings::choice::named;
use crate::space::{DesignSpace, WeightMap};
use crate::transition::TransitionStyle;
use crate::work::progress::{Progress, checkpoint};

/// Pixels along the longer side of a single picture.
const LONGER_SIDE_PX: u32 = 960;

/// In which order kept places are listed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CatalogueOrder {
    /// As they were kept.
    #[default]
    Kept,
    /// The best first.
    Stars,
    /// By their names.
    Name,
    /// The least area first.
    Area,
    /// The shortest outlines first.
    Perimeter,
    /// The least distorted first.
    Distortion,
}

named! { CatalogueOrder {
    Kept: "kept", "As kept", "In the order in which they were kept";
    Stars: "stars", "Stars", "The best first";
    Name: "name", "Name", "By their names";
    Area: "area", "Area", "The least area first";
    Perimeter: "perimeter", "Perimeter", "The shortest outlines first";
    Distortion: "distortion", "Distortion", "The least distorted first";
} }

/// Kept places with what is measured of them.
#[derive(Clone, Debug)]
pub struct Catalogue {
    entries: Vec<CatalogueEntry>,
}

/// One of them.
#[derive(Clone, Debug)]
struct CatalogueEntry {
    kept: SavedPlace,
    weights: Vec<f64>,
    measures: BlendMeasures,
}

impl Catalogue {
    /// Those of at least so many stars, in that order; equal ones as they were kept.
    ///
    /// # Panics
    /// If the map has not as many sites as the space has designs.
    #[must_use]
    pub fn new(
        (space, map): (&DesignSpace, &WeightMap),
        kept: &[SavedPlace],
        least_stars: u8,
        order: CatalogueOrder,
    ) -> Self {
        let mut sampler = BlendSampler::of(space);
        let entry = |kept: &SavedPlace| {
            let mut weights = vec![0.0; space.designs().len()];
            map.weights(kept.at, &mut weights);
            let mut kept = kept.clone();
            if kept.name.is_empty() {
                kept.name = space.told(&weights);
            }
            CatalogueEntry {
                measures: sampler.at(&weights),
                weights,
                kept,
            }
        };
        let wanted = kept.iter().filter(|kept| kept.stars >= least_stars);
        let mut entries: Vec<CatalogueEntry> = wanted.map(entry).collect();
        let distortion =
            |entry: &CatalogueEntry| entry.measures.quality.conformal_p95.unwrap_or(1.0);
        entries.sort_by(|a, b| match order {
            CatalogueOrder::Kept => std::cmp::Ordering::Equal,
            CatalogueOrder::Stars => b.kept.stars.cmp(&a.kept.stars),
            CatalogueOrder::Name => a.kept.name.cmp(&b.kept.name),
            CatalogueOrder::Area => a.measures.area.total_cmp(&b.measures.area),
            CatalogueOrder::Perimeter => a.measures.perimeter.total_cmp(&b.measures.perimeter),
            CatalogueOrder::Distortion => distortion(a).total_cmp(&distortion(b)),
        });
        Self { entries }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Writes all of it into a folder, which is made where it is missing, and returns what it
    /// wrote. Files of the same names are written over.
    ///
    /// # Errors
    /// [`ExportError`] names the file that cannot be written; those before it are whole.
    pub fn write(
        &self,
        space: &DesignSpace,
        (style, ground): (&TransitionStyle, Option<Rgb>),
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
            let stem = stem(k, &entry.kept);
            for kind in [StillKind::Svg, StillKind::Dxf] {
                let path = folder.join(format!("{stem}.{kind}"));
                match encoded(&drawing, kind, &path) {
                    Ok(bytes) => {
                        write_atomically(&path, &bytes)?;
                        written.push(path);
                    }
                    // Nothing of a field may be left.
                    Err(ExportError::NoOutlines) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        let sheet = folder.join("catalogue.png");
        let drawing = self.sheet(space, style, ground);
        write_atomically(&sheet, &encoded(&drawing, StillKind::Png, &sheet)?)?;
        let table = folder.join("catalogue.csv");
        write_atomically(
            &table,
            &self.table(space).map_err(|reason| ExportError::Encode {
                path: table.clone(),
                reason,
            })?,
        )?;
        written.extend([sheet, table]);
        Ok(written)
    }

    /// All side by side, with their names and stars.
    #[must_use]
    pub fn sheet(
        &self,
        space: &DesignSpace,
        style: &TransitionStyle,
        ground: Option<Rgb>,
    ) -> Drawing {
        // Names are long where nobody gave one: the cells of slender designs are wider.
        let own = space.bounds();
        let beside = 0.5 * (own.size().y - own.size().x).max(0.0) * DVec2::X;
        let bounds = Bounds {
            min: own.min - beside,
            max: own.max + beside,
        };
        let layout = SheetLayout::new(self.len().max(1), bounds, None);
        let mut drawing = Drawing::new(layout.size, ground);
        for (k, entry) in self.entries.iter().enumerate() {
            let (corner, inner, base) = layout.cell(k);
            let view = PlaneView::fit_cell(bounds, layout.size, corner, inner);
            self.draw(space, k, style, &view, &mut drawing);
            let words = match entry.kept.stars {
                0 => SanitizedLine(&entry.kept.name).to_string(),
                stars => format!("{}, {stars} of 5", SanitizedLine(&entry.kept.name)),
            };
            let [width, height] = layout.label_room(inner);
            let room = [width, 0.8 * height];
            drawing.push_label_within(&words, base, room, text_colour_on(ground));
        }
        drawing
    }

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

    /// A row for each, its weights by the names of the designs.
    fn table(&self, space: &DesignSpace) -> Result<Vec<u8>, String> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let before = ["file", "name", "stars", "note", "x", "y"].map(str::to_owned);
        let weights = space.designs().iter();
        let weights = weights.map(|design| format!("weight of {}", SanitizedLine(&design.name)));
        let behind = [
            "area",
            "perimeter",
            "conformal_p95",
            "travel",
            "folds",
            "crossings",
        ];
        let header = before
            .into_iter()
            .chain(weights)
            .chain(behind.map(str::to_owned));
        let wrong = |error: csv::Error| error.to_string();
        table.write_record(header).map_err(wrong)?;
        for (k, entry) in self.entries.iter().enumerate() {
            let CatalogueEntry { kept, measures, .. } = entry;
            let number = |value: f64| value.to_string();
            let maybe = |value: Option<f64>| value.map_or_else(String::new, number);
            let before = [
                stem(k, kept),
                SanitizedLine(&kept.name).to_string(),
                kept.stars.to_string(),
                SanitizedLine(&kept.note).to_string(),
                number(kept.at.x),
                number(kept.at.y),
            ];
            let weights = entry.weights.iter().copied().map(number);
            let behind = [
                number(measures.area),
                number(measures.perimeter),
                maybe(measures.quality.conformal_p95),
                maybe(measures.travel),
                measures.quality.folds.to_string(),
                measures.quality.crossings.to_string(),
            ];
            let row = before.into_iter().chain(weights).chain(behind);
            table.write_record(row).map_err(wrong)?;
        }
        table.into_inner().map_err(|error| error.to_string())
    }
}

/// The name of its files without an ending: no two have the same, and none has blanks or signs.
fn stem(k: usize, kept: &SavedPlace) -> String {
    let name = safe(&kept.name);
    let words = name.split(|c: char| !c.is_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
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
            Arc::new(Design::of_rings(name, [ring]).expect("a design"))
        };
        let designs = vec![tent("low", 1.0), tent("high", 2.0), tent("tower", 4.0)];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let map = WeightMap::new(&MapLayout::Polygon.sites(space.likeness())).expect("sites");
        (space, map)
    }

    fn kept(map: &WeightMap) -> Vec<SavedPlace> {
        let place = |site: DVec2, name: &str, stars: u8| SavedPlace {
            name: name.to_owned(),
            stars,
            ..SavedPlace::new(site)
        };
        vec![
            place(map.sites()[2], "a/b", 2),
            place(map.sites()[0], "", 5),
            place(DVec2::ZERO, "a/b", 0),
        ]
    }

    #[test]
    fn all_that_is_kept_is_written_and_measured() {
        let (space, map) = space();
        let kept = kept(&map);
        let folder = tempfile::tempdir().expect("a folder");
        let to = folder.path().join("new/catalogue");
        let catalogue = Catalogue::new((&space, &map), &kept, 0, CatalogueOrder::Area);
        let look = (&TransitionStyle::default(), None);
        let written = catalogue.write(&space, look, &to, &Silent).expect("files");
        assert_eq!(written.len(), 3 * 2 + 2);
        assert!(written.iter().all(|path| path.exists()));
        let table = std::fs::read_to_string(to.join("catalogue.csv")).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[0].contains("weight of high") && lines[1].starts_with("01-low,low,5,"));
        assert!(lines[3].starts_with("03-a-b,a/b,2,"), "{}", lines[3]);
    }

    #[test]
    fn the_best_can_be_asked_for_alone() {
        let (space, map) = space();
        let all = Catalogue::new((&space, &map), &kept(&map), 1, CatalogueOrder::Stars);
        let stars = all.entries.iter().map(|entry| entry.kept.stars);
        assert_eq!(stars.collect::<Vec<_>>(), [5, 2]);
    }

    #[test]
    fn long_names_keep_to_their_own_cells() {
        let (space, map) = space();
        let long = |site: DVec2| SavedPlace {
            name: "a name that says of which designs it is how much".to_owned(),
            ..SavedPlace::new(site)
        };
        let kept: Vec<SavedPlace> = map.sites().iter().map(|site| long(*site)).collect();
        let catalogue = Catalogue::new((&space, &map), &kept, 0, CatalogueOrder::Kept);
        let sheet = catalogue.sheet(&space, &TransitionStyle::default(), None);
        let spans = sheet.items.iter().filter_map(|item| match item {
            DrawingItem::Fill {
                outline,
                label: Some(_),
                ..
            } => {
                let xs = outline.steps.iter().filter_map(|step| match step {
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

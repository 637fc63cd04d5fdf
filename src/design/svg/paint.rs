//! What is filled in a drawing, as regions: a painter who knows two colours,
//! ink and paper, and paints in the drawing's order.

use super::SvgError;
use crate::design::flatten::Flattener;
use crate::geometry::{DVec2, FillRule, Regions, RegionsError};
use i_overlay::core::fill_rule::FillRule as OverlayFill;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use usvg::{ClipPath, Group, Node, Paint, Path, Transform};

/// Polygons to be filled by winding.
type Rings = Vec<Vec<DVec2>>;

/// The regions that are filled with ink in the end.
pub(super) fn regions(tree: &usvg::Tree, tolerance: f64) -> Result<Regions, SvgError> {
    let mut painter = Painter {
        height: tree.size().height().into(),
        flattener: Flattener::new(tolerance),
        white_is_paper: has_colour(tree.root()),
        layers: Vec::new(),
    };
    painter.group(tree.root(), None)?;
    if painter.layers.is_empty() {
        let strokes = has_strokes(tree.root());
        return Err(SvgError::NothingFilled { strokes });
    }
    let ink = composed(painter.layers);
    Ok(Regions::from_rings(&ink, FillRule::NonZero)?)
}

/// Neighbouring shapes that are of one colour.
struct Layer {
    is_paper: bool,
    rings: Rings,
}

struct Painter {
    height: f64,
    flattener: Flattener,
    white_is_paper: bool,
    layers: Vec<Layer>,
}

impl Painter {
    /// Paints a group's children, inside `clip` and the group's own.
    fn group(&mut self, group: &Group, clip: Option<&Rings>) -> Result<(), SvgError> {
        if group.opacity().get() == 0.0 {
            return Ok(());
        }
        if let Some(mask) = group.mask() {
            return Err(SvgError::Mask(mask.id().to_owned()));
        }
        let own = match group.clip_path() {
            Some(path) => {
                let inside = self.clip(path, group.abs_transform())?;
                Some(match clip {
                    Some(outer) => overlaid(&inside, outer, OverlayRule::Intersect),
                    None => inside,
                })
            }
            None => None,
        };
        let clip = own.as_ref().or(clip);
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner, clip)?,
                Node::Path(path) => self.path(path, clip)?,
                Node::Image(_) | Node::Text(_) => {}
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &Path, clip: Option<&Rings>) -> Result<(), SvgError> {
        if !is_filled(path) {
            return Ok(());
        }
        let rings = self.filled(path, Transform::identity())?;
        let rings = match clip {
            Some(clip) => overlaid(&rings, clip, OverlayRule::Intersect),
            None => rings,
        };
        let is_paper = self.white_is_paper && is_white(path);
        match self.layers.last_mut() {
            Some(layer) if layer.is_paper == is_paper => layer.rings.extend(rings),
            _ => self.layers.push(Layer { is_paper, rings }),
        }
        Ok(())
    }

    /// What a clip path lets through.
    fn clip(&mut self, clip: &ClipPath, group: Transform) -> Result<Rings, SvgError> {
        let mut rings = Vec::new();
        let base = group.pre_concat(clip.transform());
        self.clip_group(clip.root(), base, &mut rings)?;
        match clip.clip_path() {
            Some(outer) => {
                let outer = self.clip(outer, group)?;
                Ok(overlaid(&rings, &outer, OverlayRule::Intersect))
            }
            None => Ok(rings),
        }
    }

    fn clip_group(
        &mut self,
        group: &Group,
        base: Transform,
        rings: &mut Rings,
    ) -> Result<(), SvgError> {
        for node in group.children() {
            match node {
                Node::Path(path) if is_filled(path) => rings.extend(self.filled(path, base)?),
                Node::Group(inner) => {
                    let mut own = Vec::new();
                    self.clip_group(inner, base, &mut own)?;
                    if let Some(clip) = inner.clip_path() {
                        let inside = self.clip(clip, base.pre_concat(inner.abs_transform()))?;
                        own = overlaid(&own, &inside, OverlayRule::Intersect);
                    }
                    rings.extend(own);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The area that a path fills by its own rule, on the page, y up.
    fn filled(&mut self, path: &Path, base: Transform) -> Result<Rings, SvgError> {
        let t = base.pre_concat(path.abs_transform());
        let [sx, ky, kx, sy, tx, ty] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        let height = self.height;
        let rings = self.flattener.rings(path.data(), |p| {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            DVec2::new(sx * x + kx * y + tx, height - (ky * x + sy * y + ty))
        })?;
        let rule = match path.fill().map(usvg::Fill::rule) {
            Some(usvg::FillRule::EvenOdd) => FillRule::EvenOdd,
            _ => FillRule::NonZero,
        };
        match Regions::from_rings(&rings, rule) {
            Ok(regions) => Ok(regions.rings().map(|r| r.points().to_vec()).collect()),
            Err(RegionsError::Empty) => Ok(Vec::new()), // a filled line
            Err(error) => Err(error.into()),
        }
    }
}

/// Ink is added, paper taken away, from the lowest layer up.
fn composed(layers: Vec<Layer>) -> Rings {
    layers.into_iter().fold(Vec::new(), |mut ink, layer| {
        if layer.is_paper {
            return overlaid(&ink, &layer.rings, OverlayRule::Difference);
        }
        ink.extend(layer.rings);
        ink
    })
}

/// A Boolean operation on areas filled by winding.
fn overlaid(subject: &Rings, clip: &Rings, rule: OverlayRule) -> Rings {
    if subject.is_empty() {
        return Vec::new();
    }
    let plain = |rings: &Rings| -> Vec<Vec<[f64; 2]>> {
        rings
            .iter()
            .map(|ring| ring.iter().map(|p| p.to_array()).collect())
            .collect()
    };
    plain(subject)
        .overlay_as::<i64>(&plain(clip), rule, OverlayFill::NonZero)
        .into_iter()
        .flatten()
        .map(|ring| ring.into_iter().map(DVec2::from).collect())
        .collect()
}

fn is_filled(path: &Path) -> bool {
    path.is_visible() && path.fill().is_some_and(|fill| fill.opacity().get() > 0.0)
}

fn is_white(path: &Path) -> bool {
    path.fill().is_some_and(
        |fill| matches!(fill.paint(), Paint::Color(c) if [c.red, c.green, c.blue] == [u8::MAX; 3]),
    )
}

fn has_colour(group: &Group) -> bool {
    any_path(group, &|path| is_filled(path) && !is_white(path))
}

fn has_strokes(group: &Group) -> bool {
    any_path(group, &|path| path.is_visible() && path.stroke().is_some())
}

fn any_path(group: &Group, test: &impl Fn(&Path) -> bool) -> bool {
    group.children().iter().any(|node| match node {
        Node::Group(inner) => any_path(inner, test),
        Node::Path(path) => test(path),
        Node::Image(_) | Node::Text(_) => false,
    })
}

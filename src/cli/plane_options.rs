//! Warps and colours as flags: which cell, its pins and lines, its paths.

use clap::Args;

use crate::content::ContentKind;
use crate::correspondence::{LinePair, PointPair};
use crate::easing::Easing;
use crate::geometry::DVec2;
use crate::project::Project;
use crate::warp::{Course, Travel, WarpKind};

use super::options::{named, set};

#[derive(Debug, Args)]
#[command(next_help_heading = "Warp and content")]
pub(super) struct CellArgs {
    /// What moves: a row of the table
    #[arg(long, conflicts_with = "method", value_parser = named::<WarpKind>(&WarpKind::KEYS))]
    warp: Option<WarpKind>,

    /// What is seen: a column of the table
    #[arg(long, conflicts_with = "method", value_parser = named::<ContentKind>(&["solid", "field", "colours"]))]
    content: Option<ContentKind>,

    /// A point of the source and the same point of the target, in their own
    /// units, y up; may be given many times
    #[arg(long, value_name = "X,Y:X,Y", value_parser = pin, allow_hyphen_values = true)]
    pin: Vec<PointPair>,

    /// A line of the source, from end to end, and the same line of the target;
    /// may be given many times
    #[arg(long, value_name = "X,Y,X,Y:X,Y,X,Y", value_parser = line, allow_hyphen_values = true)]
    line: Vec<LinePair>,

    /// How pins and lines travel: turning as a whole, or each straight; auto
    /// is whole for fields
    #[arg(long, value_parser = named::<Travel>(&["auto", "whole", "straight"]))]
    travel: Option<Travel>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Boundary paths (paths)")]
pub(super) struct PathArgs {
    /// The paths of boundary points: straight lines, or those that lengths and
    /// directions of the edges leave
    #[arg(long, value_parser = named::<Course>(&["straight", "intrinsic"]))]
    path: Option<Course>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Colours")]
pub(super) struct ColourArgs {
    /// How the mix of two pictures runs over t
    #[arg(long, value_parser = named::<Easing>(&["linear", "smooth", "ease-in", "ease-out"]))]
    mix: Option<Easing>,

    /// The t at which the source begins to give way
    #[arg(long, value_name = "T")]
    mix_from: Option<f64>,

    /// The t from which on only the target is seen
    #[arg(long, value_name = "T")]
    mix_to: Option<f64>,
}

impl CellArgs {
    pub fn edit(&self, project: &mut Project) {
        set(&mut project.warp, self.warp.map(Some));
        set(&mut project.content, self.content.map(Some));
        set(&mut project.options.travel, self.travel);
        project.options.matching.pins.extend(&self.pin);
        project.options.matching.lines.extend(&self.line);
    }
}

impl PathArgs {
    pub fn edit(&self, project: &mut Project) {
        set(&mut project.options.paths.course, self.path);
    }
}

impl ColourArgs {
    pub fn edit(&self, project: &mut Project) {
        let mix = &mut project.options.colours;
        set(&mut mix.curve, self.mix);
        set(&mut mix.from, self.mix_from);
        set(&mut mix.to, self.mix_to);
    }
}

fn pin(text: &str) -> Result<PointPair, String> {
    let [source, target] = halves(text)?.map(numbers::<2>);
    let hint = || "write a point of the source and one of the target, as 10,20:12,24".to_owned();
    let (source, target) = (source.ok_or_else(hint)?, target.ok_or_else(hint)?);
    Ok(PointPair {
        source: DVec2::from_array(source),
        target: DVec2::from_array(target),
    })
}

fn line(text: &str) -> Result<LinePair, String> {
    let [source, target] = halves(text)?.map(numbers::<4>);
    let hint = || "write both ends in the source and in the target, as 0,0,9,0:1,2,9,3".to_owned();
    let ends = |[a, b, c, d]: [f64; 4]| [DVec2::new(a, b), DVec2::new(c, d)];
    Ok(LinePair {
        source: ends(source.ok_or_else(hint)?),
        target: ends(target.ok_or_else(hint)?),
    })
}

fn halves(text: &str) -> Result<[&str; 2], String> {
    let (source, target) = text
        .split_once(':')
        .ok_or("put a colon between the source's place and the target's")?;
    Ok([source, target])
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let each = text.split(',').map(|n| n.trim().parse().ok());
    let all: Vec<f64> = each.collect::<Option<_>>()?;
    let finite = all.iter().all(|n| n.is_finite());
    all.try_into().ok().filter(|_| finite)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_are_read() {
        let found = pin("1,-2: 3.5,4").expect("a pin");
        assert_eq!(found.source, DVec2::new(1.0, -2.0));
        assert_eq!(found.target, DVec2::new(3.5, 4.0));
        let found = line("0,0,1,0:0,0,0,2").expect("a line");
        assert_eq!(found.target[1], DVec2::new(0.0, 2.0));
        for wrong in ["", "1,2", "1,2:3", "1,2:3,4,5", "1,nan:2,3", "a,b:c,d"] {
            assert!(pin(wrong).is_err(), "{wrong}");
            assert!(line(wrong).is_err(), "{wrong}");
        }
    }
}

//! Tests that each flag changes its option in the project, and that invalid values are refused.

use super::*;
use crate::colour::Rgb;
use crate::content::{BlendSpace, ContentKind};
use crate::field::Metric;
use crate::transition::{
    BuildQuality, CollisionAvoidance, DesignFit, FieldBoundary, NamedEasing, PaintRule, PlayMode,
};
use crate::warp::homotopy::Homotopy;
use crate::warp::{ArapPath, FaceWeights, VertexPath, WarpKind};
use clap::{CommandFactory, Parser};

#[derive(Debug, Parser)]
struct ParsedMethodArgs {
    #[command(flatten)]
    method: MethodArgs,
}

/// Returns a default project with the flags applied.
fn with_flags(flags: &str) -> Result<Project, CliError> {
    let arguments = std::iter::once("x").chain(flags.split_whitespace());
    let parsed = ParsedMethodArgs::try_parse_from(arguments).map_err(CliError::usage)?;
    let mut project = Project::from_pair("a.svg", "b.svg");
    parsed.method.edit(&mut project)?;
    Ok(project)
}

#[test]
fn every_listed_value_is_accepted() {
    for argument in ParsedMethodArgs::command().get_arguments() {
        let flag = argument.get_long().unwrap_or_default();
        for value in argument.get_possible_values() {
            let flags = format!("--{flag} {}", value.get_name());
            let takes_value = argument.get_action().takes_values();
            assert!(!takes_value || with_flags(&flags).is_ok(), "{flags}");
        }
    }
}

#[test]
fn without_flags_nothing_changes() {
    let project = Project::from_pair("a.svg", "b.svg");
    assert_eq!(with_flags("").expect("edited"), project);
}

#[test]
fn method_flags_change_their_options() {
    let project = with_flags(
        "--method field --fit same-area --quality draft --guard plain --bar-width 0.02 --homotopy exponential \
         --weights 1,2.5 --one-sided --extra-turns 0,-1 --anchor 3 --subdivisions 1 \
         --metric chessboard --boundary binary --space real --epsilon 2 --threshold -1.5 \
         --cells 64 --margin 0.2 --path straight",
    )
    .expect("edited");
    assert_eq!(
        (project.warp, project.content),
        (Some(WarpKind::None), Some(ContentKind::Field))
    );
    assert_eq!(
        (project.fit, project.options.bar_width),
        (DesignFit::SameArea, 0.02)
    );
    assert_eq!(project.options.quality, BuildQuality::Draft);
    assert_eq!(project.options.guard, CollisionAvoidance::Off);
    assert_eq!(project.options.arap.homotopy, Homotopy::Exponential);
    assert_eq!(
        project.options.arap.weights,
        FaceWeights::PerFace(vec![1.0, 2.5])
    );
    assert_eq!(
        (
            project.options.arap.symmetric,
            project.options.arap.subdivisions
        ),
        (false, 1)
    );
    assert_eq!(project.options.arap.extra_turns, [0, -1]);
    assert_eq!(project.options.arap.path, ArapPath::Anchor(3));
    assert_eq!(project.options.field.metric, Metric::Chessboard);
    assert_eq!(project.options.field.boundary, FieldBoundary::Binary);
    assert_eq!(project.options.field.blend.space, BlendSpace::Real);
    assert_eq!(
        (
            project.options.field.blend.epsilon,
            project.options.field.blend.threshold
        ),
        (2.0, -1.5)
    );
    assert_eq!(
        (project.options.field.cells, project.options.field.margin),
        (64, 0.2)
    );
    assert_eq!(project.options.paths.course, VertexPath::Straight);
}

#[test]
fn import_timing_and_style_flags_change_their_options() {
    let project = with_flags(
        "--image-threshold 99 --invert --specks 4 --tolerance 0.01 --no-strokes --colours \
         --from -0.5 --to 1.5 --duration 3 --hold 0 --easing ease-in --play loop \
         --source-colour #010203 --target-colour #040506 --no-joints --paint one \
         --fade --reorder-at 0.3",
    )
    .expect("edited");
    let import = project.designs[1].import;
    assert_eq!((import.threshold, import.invert), (Some(99), true));
    assert_eq!((import.specks_px, import.tolerance), (4, 0.01));
    assert!(!import.strokes && import.colours);
    assert_eq!((project.timing.from, project.timing.to), (-0.5, 1.5));
    assert_eq!(
        (project.timing.duration_secs, project.timing.hold_secs),
        (3.0, 0.0)
    );
    assert_eq!(
        (project.timing.easing, project.timing.play),
        (NamedEasing::EaseIn.into(), PlayMode::Loop)
    );
    assert_eq!(project.style.source, Rgb([1, 2, 3]));
    assert_eq!(
        (project.style.target, project.style.joints),
        (Rgb([4, 5, 6]), false)
    );
    assert_eq!(project.options.paint, PaintRule::One);
    let coats = project.options.coats;
    assert!(coats.fade && coats.reorder_at == 0.3);
}

#[test]
fn invalid_values_are_usage_errors() {
    for flags in [
        "--homotopy cubic",
        "--weights 1,x",
        "--duration 0",
        "--to 0",
        "--source-colour red",
        "--anchor 1 --centroid",
    ] {
        assert!(
            matches!(with_flags(flags), Err(CliError::Usage(_))),
            "{flags}"
        );
    }
}

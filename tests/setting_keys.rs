//! Tests that the keys of the settings with fixed choices do not change: they are stored in files
//! and given on the command line.

use std::collections::HashSet;
use std::fmt::{Debug, Display};

use morphospace::content::{BlendSpace, ContentKind};
use morphospace::correspondence::{HoleRule, PartRule};
use morphospace::design::PictureReading;
use morphospace::export::{Aspect, FilmKind, LayoutPreset, StillKind};
use morphospace::field::Metric;
use morphospace::measure::{MapMeasure, Quantity};
use morphospace::settings::{Choice, choice_keys};
use morphospace::space::MapLayout;
use morphospace::time::NamedEasing;
use morphospace::transition::{
    BuildQuality, CollisionAvoidance, DesignFit, FieldBoundary, PlayMode,
};
use morphospace::warp::homotopy::Homotopy;
use morphospace::warp::{FeatureTravel, LineInterpolation, RadialBasis, VertexPath, WarpKind};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Checks the setting type `T`: its sorted keys are `expected`, its titles are unique, and its
/// choices are written and read by their keys.
fn check_choices<T>(expected: &str)
where
    T: Choice + Debug + Display + Serialize + DeserializeOwned,
{
    let mut keys_found: Vec<_> = choice_keys::<T>().collect();
    keys_found.sort_unstable();
    assert_eq!(keys_found.join(" "), expected);
    let titles: HashSet<_> = T::CHOICES.iter().map(|c| c.name().title).collect();
    assert_eq!(
        titles.len(),
        keys_found.len(),
        "a repeated title: {expected}"
    );
    for &choice in T::CHOICES {
        let name = choice.name();
        assert_eq!(choice.to_string(), name.key);
        let written = serde_json::to_value(choice).expect("written");
        assert_eq!(written, name.key);
        assert_eq!(serde_json::from_value::<T>(written).expect("read"), choice);
        assert!(!name.title.is_empty() && !name.sentence.is_empty());
    }
    for invalid in ["", " ", "Linear", "\u{1b}[31m"] {
        let json = serde_json::to_string(invalid).expect("text");
        let error = serde_json::from_str::<T>(&json).expect_err(invalid);
        let message = error.to_string();
        assert!(
            message.contains(keys_found[0]) && !message.contains('\u{1b}'),
            "{message}"
        );
    }
    assert!(serde_json::from_str::<T>("1").is_err());
}

#[test]
fn keys_match_those_in_existing_files() {
    check_choices::<BlendSpace>("log real");
    check_choices::<ContentKind>("colours field solid");
    check_choices::<HoleRule>("alone auto close cut");
    check_choices::<PartRule>("alone auto split");
    check_choices::<NamedEasing>("ease-in ease-out linear smooth");
    check_choices::<Metric>("chessboard city-block euclidean quasi-euclidean");
    check_choices::<Homotopy>("bounded exponential linear linear-after-polar polar");
    check_choices::<FieldBoundary>("binary exact");
    check_choices::<PictureReading>("auto brightness colour opacity");
    check_choices::<DesignFit>("as-drawn auto centred same-area");
    check_choices::<PlayMode>("loop once ping-pong");
    check_choices::<BuildQuality>("best draft");
    check_choices::<CollisionAvoidance>("guarded plain");
    check_choices::<RadialBasis>("gaussian multiquadric thin-plate");
    check_choices::<LineInterpolation>("ends middle-and-angle");
    check_choices::<VertexPath>("intrinsic straight");
    check_choices::<FeatureTravel>("auto straight whole");
    check_choices::<WarpKind>("arap lattice lines none paths scattered");
    check_choices::<FilmKind>("apng gif html json mov mp4 svg webm");
    check_choices::<Aspect>("16:9 1:1 4:3 9:16 own");
    check_choices::<LayoutPreset>("deck page post story");
    check_choices::<StillKind>("dxf png svg");
    check_choices::<MapMeasure>("area distortion perimeter travel");
    check_choices::<MapLayout>("likeness line polygon");
    #[cfg(feature = "cli")]
    check_choices::<morphospace::export::CatalogueOrder>(
        "area distortion kept name perimeter stars",
    );
    check_choices::<Quantity>(
        "area crossings folds holes min-det perimeter pieces turning worst-conformal \
         worst-isometric",
    );
}

//! Every table of names: what files and command lines hold must not change.

use std::collections::HashSet;
use std::fmt::{Debug, Display};

use morphospace::content::{BlendSpace, ContentKind};
use morphospace::correspondence::{HoleRule, PartRule};
use morphospace::export::{Aspect, FilmKind, LayoutPreset, StillKind};
use morphospace::field::Metric;
use morphospace::measure::{MapMeasure, Quantity};
use morphospace::settings::choice::{Choice, keys};
use morphospace::space::MapLayout;
use morphospace::time::easing::NamedEasing;
use morphospace::transition::{
    BuildQuality, CollisionAvoidance, DesignFit, FieldBoundary, PlayMode,
};
use morphospace::warp::homotopy::Homotopy;
use morphospace::warp::{FeatureTravel, LineInterpolation, RadialBasis, VertexPath, WarpKind};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The table of an option whose keys, sorted, are these.
fn table<T>(expected: &str)
where
    T: Choice + Debug + Display + Serialize + DeserializeOwned,
{
    let mut found: Vec<_> = keys::<T>().collect();
    found.sort_unstable();
    assert_eq!(found.join(" "), expected);
    let titles: HashSet<_> = T::CHOICES.iter().map(|c| c.name().title).collect();
    assert_eq!(titles.len(), found.len(), "a title twice: {expected}");
    for &choice in T::CHOICES {
        let name = choice.name();
        assert_eq!(choice.to_string(), name.key);
        let written = serde_json::to_value(choice).expect("written");
        assert_eq!(written, name.key);
        assert_eq!(serde_json::from_value::<T>(written).expect("read"), choice);
        assert!(!name.title.is_empty() && !name.sentence.is_empty());
    }
    for wrong in ["", " ", "Linear", "\u{1b}[31m"] {
        let json = serde_json::to_string(wrong).expect("text");
        let error = serde_json::from_str::<T>(&json).expect_err(wrong);
        let said = error.to_string();
        assert!(
            said.contains(found[0]) && !said.contains('\u{1b}'),
            "{said}"
        );
    }
    assert!(serde_json::from_str::<T>("1").is_err());
}

#[test]
fn keys_are_those_of_the_files_that_there_are() {
    table::<BlendSpace>("log real");
    table::<ContentKind>("colours field solid");
    table::<HoleRule>("alone auto close cut");
    table::<PartRule>("alone auto split");
    table::<NamedEasing>("ease-in ease-out linear smooth");
    table::<Metric>("chessboard city-block euclidean quasi-euclidean");
    table::<Homotopy>("bounded exponential linear linear-after-polar polar");
    table::<FieldBoundary>("binary exact");
    table::<DesignFit>("as-drawn centred same-area");
    table::<PlayMode>("loop once ping-pong");
    table::<BuildQuality>("best draft");
    table::<CollisionAvoidance>("guarded plain");
    table::<RadialBasis>("gaussian multiquadric thin-plate");
    table::<LineInterpolation>("ends middle-and-angle");
    table::<VertexPath>("intrinsic straight");
    table::<FeatureTravel>("auto straight whole");
    table::<WarpKind>("arap lattice lines none paths scattered");
    table::<FilmKind>("apng gif html json mp4 svg");
    table::<Aspect>("16:9 1:1 4:3 9:16 own");
    table::<LayoutPreset>("deck page post story");
    table::<StillKind>("dxf png svg");
    table::<MapMeasure>("area distortion perimeter travel");
    table::<MapLayout>("likeness line polygon");
    #[cfg(feature = "cli")]
    table::<morphospace::export::CatalogueOrder>("area distortion kept name perimeter stars");
    table::<Quantity>(
        "area crossings folds holes min-det perimeter pieces turning worst-conformal \
         worst-isometric",
    );
}

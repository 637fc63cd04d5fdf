//! A project file with a changed match: whatever it contains, the motion is that of the designs.
//! It is placed, measured, proved and exported.

use crate::random::transition_check::check_film;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use morphospace::design::{Design, ImportOptions, import};
use morphospace::export::{FilmSpec, VectorAnimation};
use morphospace::project::Project;
use morphospace::recording::RecordingOptions;
use morphospace::transition::{BuildQuality, TransitionSpec};
use morphospace::work::progress::Silent;
use morphospace::{Camera, Transition};
use std::io::Read;
use std::sync::{Arc, OnceLock};

/// Match of two designs, ready to be changed.
struct StoredMatch {
    spec: TransitionSpec,
    /// Key of the designs.
    key: String,
    /// The match and its motion, as MessagePack.
    bytes: Vec<u8>,
}

/// Changes bytes of a stored match, given by position (modulo the length) and value, puts it into
/// the text of a project, and checks the transition that is built from it.
pub fn check_cached_match(changes: &[(u32, u8)]) {
    static STORED: OnceLock<StoredMatch> = OnceLock::new();
    let stored = STORED.get_or_init(stored_match);
    let mut bytes = stored.bytes.clone();
    for &(at, value) in changes {
        let length = bytes.len();
        bytes[at as usize % length] = value;
    }
    let mut spec = stored.spec.clone();
    spec.cached_match = Project::parse(&project_text(&stored.key, &bytes))
        .expect("a project with any match")
        .found;
    let transition = Transition::build(&spec, &Silent).expect("the match is found anew");
    check_transition(&transition);
}

fn check_transition(transition: &Transition) {
    check_film(transition).expect("a valid film");
    transition
        .prove(&RecordingOptions::default(), &Silent)
        .expect("a recording");
    let camera = Camera::around(transition.clone(), 24);
    assert!(camera.svg(0.5).contains("<path"));
    let film = FilmSpec::evenly(0.0, 1.0, 5, 25.0).expect("five frames");
    let animation = VectorAnimation::record(&camera, &film, &Silent).expect("outlines");
    assert!(animation.lottie("fuzzed").contains("layers"));
}

/// Matches two drawings with moving parts, an unmatched hole and a part that appears.
fn stored_match() -> StoredMatch {
    let bars = design("M32 30h12v40h-12z M56 30h12v40h-12z M34 40v4h4v-4z");
    let others = design("M30 30h12v40h-12z M56 32h14v38h-14z M2 2h6v6h-6z");
    let mut spec = TransitionSpec::new(bars, others);
    spec.options.quality = BuildQuality::Draft;
    let built = Transition::build(&spec, &Silent).expect("a transition");
    let found = built.cached_match().expect("outlines were matched");
    let fields = toml::Table::try_from(&found).expect("a table");
    let text = |key: &str| fields[key].as_str().expect("text").to_owned();
    let packed = STANDARD
        .decode(text("film").replace('\n', ""))
        .expect("base64");
    let mut bytes = Vec::new();
    let mut decoder = ZlibDecoder::new(packed.as_slice());
    decoder.read_to_end(&mut bytes).expect("compressed bytes");
    StoredMatch {
        spec,
        key: text("for"),
        bytes,
    }
}

fn design(path: &str) -> Arc<Design> {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{path}'/></svg>");
    Arc::new(import("a.svg", text.as_bytes(), &ImportOptions::default()).expect("a drawing"))
}

fn project_text(key: &str, bytes: &[u8]) -> String {
    let mut packed = Vec::new();
    let mut encoder = ZlibEncoder::new(bytes, Compression::fast());
    encoder.read_to_end(&mut packed).expect("in memory");
    let film = STANDARD.encode(packed);
    format!(
        "version = 1\n[[designs]]\npath = 'a.svg'\n[[designs]]\npath = 'b.svg'\n[found]\nfor = '{key}'\nfilm = '{film}'\n"
    )
}

//! Nothing is lost in silence: each element and each property of SVG 1.1 is drawn, or reported with
//! the element that uses it, or has no effect on a still picture in any browser.

use super::*;

/// Effect that a feature must have on the import.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effect {
    /// The drawing differs from the one without the feature.
    Drawn,
    /// A note names the feature and the element.
    Reported,
    /// The drawing is the same, and there is no note.
    Invisible,
    /// The effect depends on the installed fonts: the drawing differs or stays the same.
    Fonts,
}

use Effect::{Drawn, Fonts, Invisible, Reported};

/// All elements of SVG 1.1 (second edition, appendix J), each in a minimal drawing. Elements that
/// are reported have the id `e`, or stand in an element that has it.
const ELEMENTS: [(&str, Effect, &str); 80] = [
    ("a", Drawn, "<a><rect width='9' height='9'/></a>"),
    (
        "altGlyph",
        Reported,
        "<text y='9'><altGlyph id='e'>A</altGlyph></text>",
    ),
    (
        "altGlyphDef",
        Reported,
        "<defs><altGlyphDef id='e'/></defs>",
    ),
    (
        "altGlyphItem",
        Reported,
        "<defs><altGlyphItem id='e'/></defs>",
    ),
    (
        "animate",
        Reported,
        "<rect id='e'><animate attributeName='x'/></rect>",
    ),
    (
        "animateColor",
        Reported,
        "<rect id='e'><animateColor attributeName='fill'/></rect>",
    ),
    (
        "animateMotion",
        Reported,
        "<rect id='e'><animateMotion path='M0 0H9'/></rect>",
    ),
    (
        "animateTransform",
        Reported,
        "<rect id='e'><animateTransform type='rotate'/></rect>",
    ),
    ("circle", Drawn, "<circle cx='20' cy='20' r='9'/>"),
    (
        "clipPath",
        Drawn,
        "<clipPath id='c'><rect width='5' height='9'/></clipPath><rect width='9' height='9' clip-path='url(#c)'/>",
    ),
    (
        "color-profile",
        Reported,
        "<color-profile id='e' name='p'/>",
    ),
    ("cursor", Invisible, "<cursor/>"),
    (
        "defs",
        Invisible,
        "<defs><rect width='9' height='9'/></defs>",
    ),
    ("desc", Invisible, "<desc>text</desc>"),
    ("ellipse", Drawn, "<ellipse cx='20' cy='20' rx='9' ry='5'/>"),
    ("feBlend", Reported, "<filter id='f'><feBlend/></filter>"),
    (
        "feColorMatrix",
        Reported,
        "<filter id='f'><feColorMatrix/></filter>",
    ),
    (
        "feComponentTransfer",
        Reported,
        "<filter id='f'><feComponentTransfer/></filter>",
    ),
    (
        "feComposite",
        Reported,
        "<filter id='f'><feComposite/></filter>",
    ),
    (
        "feConvolveMatrix",
        Reported,
        "<filter id='f'><feConvolveMatrix/></filter>",
    ),
    (
        "feDiffuseLighting",
        Reported,
        "<filter id='f'><feDiffuseLighting/></filter>",
    ),
    (
        "feDisplacementMap",
        Reported,
        "<filter id='f'><feDisplacementMap/></filter>",
    ),
    (
        "feDistantLight",
        Reported,
        "<filter id='f'><feDiffuseLighting><feDistantLight/></feDiffuseLighting></filter>",
    ),
    ("feFlood", Reported, "<filter id='f'><feFlood/></filter>"),
    (
        "feFuncA",
        Reported,
        "<filter id='f'><feComponentTransfer><feFuncA/></feComponentTransfer></filter>",
    ),
    (
        "feFuncB",
        Reported,
        "<filter id='f'><feComponentTransfer><feFuncB/></feComponentTransfer></filter>",
    ),
    (
        "feFuncG",
        Reported,
        "<filter id='f'><feComponentTransfer><feFuncG/></feComponentTransfer></filter>",
    ),
    (
        "feFuncR",
        Reported,
        "<filter id='f'><feComponentTransfer><feFuncR/></feComponentTransfer></filter>",
    ),
    (
        "feGaussianBlur",
        Reported,
        "<filter id='f'><feGaussianBlur stdDeviation='2'/></filter>",
    ),
    ("feImage", Reported, "<filter id='f'><feImage/></filter>"),
    ("feMerge", Reported, "<filter id='f'><feMerge/></filter>"),
    (
        "feMergeNode",
        Reported,
        "<filter id='f'><feMerge><feMergeNode/></feMerge></filter>",
    ),
    (
        "feMorphology",
        Reported,
        "<filter id='f'><feMorphology radius='2'/></filter>",
    ),
    (
        "feOffset",
        Reported,
        "<filter id='f'><feOffset dx='2'/></filter>",
    ),
    (
        "fePointLight",
        Reported,
        "<filter id='f'><feDiffuseLighting><fePointLight/></feDiffuseLighting></filter>",
    ),
    (
        "feSpecularLighting",
        Reported,
        "<filter id='f'><feSpecularLighting/></filter>",
    ),
    (
        "feSpotLight",
        Reported,
        "<filter id='f'><feDiffuseLighting><feSpotLight/></feDiffuseLighting></filter>",
    ),
    ("feTile", Reported, "<filter id='f'><feTile/></filter>"),
    (
        "feTurbulence",
        Reported,
        "<filter id='f'><feTurbulence/></filter>",
    ),
    ("filter", Reported, "<filter id='f'/>"),
    ("font", Reported, "<font id='e'/>"),
    ("font-face", Reported, "<font-face id='e'/>"),
    (
        "font-face-format",
        Reported,
        "<font-face id='e'><font-face-src><font-face-uri><font-face-format/></font-face-uri></font-face-src></font-face>",
    ),
    (
        "font-face-name",
        Reported,
        "<font-face id='e'><font-face-src><font-face-name/></font-face-src></font-face>",
    ),
    (
        "font-face-src",
        Reported,
        "<font-face id='e'><font-face-src/></font-face>",
    ),
    (
        "font-face-uri",
        Reported,
        "<font-face id='e'><font-face-src><font-face-uri/></font-face-src></font-face>",
    ),
    (
        "foreignObject",
        Reported,
        "<foreignObject id='e' width='9' height='9'/>",
    ),
    ("g", Drawn, "<g><rect width='9' height='9'/></g>"),
    ("glyph", Reported, "<font id='e'><glyph/></font>"),
    (
        "glyphRef",
        Reported,
        "<altGlyphDef id='e'><glyphRef/></altGlyphDef>",
    ),
    ("hkern", Reported, "<font id='e'><hkern/></font>"),
    (
        "image",
        Drawn,
        "<image width='9' height='9' href=\"data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' width='9' height='9'%3E%3Crect width='9' height='9'/%3E%3C/svg%3E\"/>",
    ),
    ("line", Drawn, "<line x2='9' y2='9' stroke='red'/>"),
    (
        "linearGradient",
        Drawn,
        "<linearGradient id='p'><stop stop-color='red'/><stop offset='1'/></linearGradient>",
    ),
    (
        "marker",
        Drawn,
        "<marker id='m'><rect width='3' height='3'/></marker><path d='M5 5H40' marker-start='url(#m)'/>",
    ),
    (
        "mask",
        Drawn,
        "<mask id='k'><rect width='5' height='5' fill='white'/></mask><rect width='9' height='9' mask='url(#k)'/>",
    ),
    ("metadata", Invisible, "<metadata>text</metadata>"),
    (
        "missing-glyph",
        Reported,
        "<font id='e'><missing-glyph/></font>",
    ),
    (
        "mpath",
        Reported,
        "<rect id='e'><animateMotion><mpath href='#b'/></animateMotion></rect>",
    ),
    ("path", Drawn, "<path d='M0 0H9V9Z'/>"),
    (
        "pattern",
        Drawn,
        "<pattern id='p' width='.5' height='1'><rect width='3' height='9'/></pattern>",
    ),
    ("polygon", Drawn, "<polygon points='0 0 9 0 9 9'/>"),
    ("polyline", Drawn, "<polyline points='0 0 9 0 9 9'/>"),
    (
        "radialGradient",
        Drawn,
        "<radialGradient id='p'><stop stop-color='red'/><stop offset='1'/></radialGradient>",
    ),
    ("rect", Drawn, "<rect width='9' height='9'/>"),
    ("script", Invisible, "<script>text</script>"),
    (
        "set",
        Reported,
        "<rect id='e'><set attributeName='x' to='1'/></rect>",
    ),
    (
        "stop",
        Drawn,
        "<linearGradient id='p'><stop stop-color='red'/></linearGradient>",
    ),
    ("style", Drawn, "<style>#b{fill:lime}</style>"),
    ("svg", Drawn, "<svg><rect width='9' height='9'/></svg>"),
    (
        "switch",
        Drawn,
        "<switch><rect width='9' height='9'/></switch>",
    ),
    (
        "symbol",
        Drawn,
        "<symbol id='s'><rect width='9' height='9'/></symbol><use href='#s'/>",
    ),
    ("text", Drawn, "<text y='9'>A</text>"),
    (
        "textPath",
        Drawn,
        "<text><textPath href='#b'>A</textPath></text>",
    ),
    ("title", Invisible, "<title>text</title>"),
    (
        "tref",
        Drawn,
        "<text id='t' y='9'>A</text><text y='30'><tref href='#t'/></text>",
    ),
    ("tspan", Drawn, "<text y='9'><tspan>A</tspan></text>"),
    ("use", Drawn, "<use href='#b' x='-40'/>"),
    ("view", Invisible, "<view/>"),
    ("vkern", Reported, "<font id='e'><vkern/></font>"),
];

/// All properties of SVG 1.1 (second edition, appendix N), each with a value other than the initial
/// one, and the drawing in which `@` stands for the attribute.
const PROPERTIES: [(&str, &str, Effect, &str); 60] = [
    ("alignment-baseline", "hanging", Drawn, TSPAN),
    ("baseline-shift", "super", Drawn, TSPAN),
    (
        "clip",
        "rect(0 1px 1px 0)",
        Reported,
        "<svg id='e' @><rect width='9' height='9'/></svg>",
    ),
    (
        "clip-path",
        "url(#c)",
        Drawn,
        "<clipPath id='c'><rect width='5' height='5'/></clipPath><rect id='e' width='9' height='9' @/>",
    ),
    (
        "clip-rule",
        "evenodd",
        Drawn,
        "<clipPath id='c'><path d='M0 0H9V9H0ZM2 2H7V7H2Z' @/></clipPath><rect id='e' width='9' height='9' clip-path='url(#c)'/>",
    ),
    (
        "color",
        "red",
        Drawn,
        "<g @><rect width='9' height='9' fill='currentColor'/></g>",
    ),
    ("color-interpolation", "linearRGB", Reported, RECT),
    ("color-interpolation-filters", "sRGB", Invisible, RECT),
    ("color-profile", "auto", Invisible, RECT),
    ("color-rendering", "optimizeSpeed", Invisible, RECT),
    ("cursor", "help", Invisible, RECT),
    ("direction", "rtl", Reported, TEXT),
    ("display", "none", Drawn, RECT),
    ("dominant-baseline", "hanging", Drawn, TEXT),
    ("enable-background", "new", Invisible, RECT),
    ("fill", "red", Drawn, RECT),
    ("fill-opacity", ".5", Drawn, RECT),
    (
        "fill-rule",
        "evenodd",
        Drawn,
        "<path d='M0 0H9V9H0ZM2 2H7V7H2Z' @/>",
    ),
    (
        "filter",
        "url(#f)",
        Reported,
        "<filter id='f'/><rect id='e' width='9' height='9' @/>",
    ),
    ("flood-color", "red", Invisible, RECT),
    ("flood-opacity", ".5", Invisible, RECT),
    (
        "font",
        "40px serif",
        Drawn,
        "<text y='40' style='@'>A</text>",
    ),
    ("font-family", "No Such Font", Reported, TEXT),
    ("font-size", "40", Drawn, TEXT),
    ("font-size-adjust", ".3", Reported, TEXT),
    ("font-stretch", "condensed", Fonts, TEXT),
    ("font-style", "italic", Fonts, TEXT),
    ("font-variant", "small-caps", Reported, TEXT),
    ("font-weight", "bold", Fonts, TEXT),
    ("glyph-orientation-horizontal", "90", Reported, TEXT),
    ("glyph-orientation-vertical", "90", Reported, TEXT),
    ("image-rendering", "optimizeSpeed", Invisible, RECT),
    ("kerning", "0", Fonts, TEXT),
    ("letter-spacing", "5", Drawn, TEXT),
    ("lighting-color", "red", Invisible, RECT),
    (
        "marker",
        "url(#m)",
        Drawn,
        "<marker id='m'><rect width='3' height='3'/></marker><path d='M5 5H40' style='@'/>",
    ),
    ("marker-end", "url(#m)", Drawn, MARKED),
    ("marker-mid", "url(#m)", Drawn, MARKED),
    ("marker-start", "url(#m)", Drawn, MARKED),
    (
        "mask",
        "url(#k)",
        Drawn,
        "<mask id='k'><rect width='5' height='5' fill='white'/></mask><rect width='9' height='9' @/>",
    ),
    ("opacity", ".5", Drawn, RECT),
    (
        "overflow",
        "visible",
        Drawn,
        "<svg width='5' height='5' @><rect width='9' height='9'/></svg>",
    ),
    ("pointer-events", "none", Invisible, RECT),
    ("shape-rendering", "crispEdges", Invisible, RECT),
    ("stop-color", "red", Drawn, GRADIENT),
    ("stop-opacity", ".5", Drawn, GRADIENT),
    ("stroke", "red", Drawn, "<path d='M0 5H40' @/>"),
    ("stroke-dasharray", "4", Drawn, LINE),
    (
        "stroke-dashoffset",
        "2",
        Drawn,
        "<path d='M0 5H40' stroke='red' stroke-dasharray='4 9' @/>",
    ),
    ("stroke-linecap", "round", Drawn, LINE),
    (
        "stroke-linejoin",
        "bevel",
        Drawn,
        "<path d='M5 20H20V40' fill='none' stroke-width='4' stroke='red' @/>",
    ),
    (
        "stroke-miterlimit",
        "1",
        Drawn,
        "<path d='M5 20H20V40' fill='none' stroke-width='4' stroke='red' @/>",
    ),
    ("stroke-opacity", ".5", Drawn, LINE),
    ("stroke-width", "4", Drawn, LINE),
    ("text-anchor", "end", Drawn, TEXT),
    ("text-decoration", "underline", Drawn, TEXT),
    ("text-rendering", "optimizeSpeed", Fonts, TEXT),
    ("unicode-bidi", "bidi-override", Reported, TEXT),
    ("visibility", "hidden", Drawn, RECT),
    ("word-spacing", "5", Drawn, TEXT),
];

const RECT: &str = "<rect id='e' width='9' height='9' @/>";
const TEXT: &str = "<text id='e' x='40' y='40' @>AV a</text>";
const TSPAN: &str = "<text x='40' y='40'>A<tspan id='e' @>b</tspan></text>";
const LINE: &str = "<path d='M10 20H40' stroke='red' @/>";
const MARKED: &str = "<marker id='m'><rect width='3' height='3'/></marker><path d='M5 5H20H40' @/>";
const GRADIENT: &str =
    "<linearGradient id='p'><stop @/><stop offset='1' stop-color='blue'/></linearGradient>";

/// Content of every drawing: a shape with a gradient or pattern `p` and a filter `f`, if defined.
const BASE: &str = "<rect id='b' x='60' y='60' width='20' height='20' fill='url(#p) gray'/>";

/// Imports a drawing; returns a description of what it shows, and its notes.
fn import(content: &str) -> (String, Vec<String>) {
    let found = stroked(&format!("{BASE}{content}"), None).expect(content);
    let notes = found.notes.iter().map(ToString::to_string).collect();
    let layers = found.paint_layers.iter().map(|layer| {
        let Bounds { min, max } = layer.regions.bounds();
        let (area, paint) = (layer.regions.area(), layer.paint);
        let points = layer.regions.rings().flat_map(|ring| ring.points());
        // Distinguishes areas of the same size and box.
        let area = area + points.map(|p| p.length_squared()).sum::<f64>();
        format!(
            "{area:.3} {min:.3} {max:.3} {paint:?} {:?} {:?}",
            layer.gradient, layer.line
        )
    });
    (layers.collect(), notes)
}

/// Asserts that a drawing with a feature shows its effect, compared to the one without it.
fn assert_effect(feature: &str, effect: Effect, with: &str, without: &str) {
    let ((drawn, notes), (base, base_notes)) = (import(with), import(without));
    assert_eq!(base_notes, [""; 0], "{feature}: {without}");
    match effect {
        Effect::Drawn => assert!(drawn != base && notes.is_empty(), "{feature}: {notes:?}"),
        Effect::Invisible => assert_eq!((drawn, notes), (base, Vec::new()), "{feature}"),
        Effect::Fonts => {}
        Effect::Reported => {
            let is_named = |note: &String| note.contains("(#e)");
            assert!(notes.iter().any(is_named), "{feature}: {notes:?}");
        }
    }
}

#[test]
fn each_element_of_svg_1_1_is_drawn_or_reported() {
    for (name, effect, content) in ELEMENTS {
        assert!(content.contains(&format!("<{name}")), "{name}: {content}");
        let is_filter = content.starts_with("<filter");
        let user = if is_filter {
            "<rect id='e' width='9' height='9' filter='url(#f)'/>"
        } else {
            ""
        };
        assert_effect(name, effect, &format!("{content}{user}"), "");
        if effect == Reported {
            let notes = import(&format!("{content}{user}")).1.join("; ");
            let root = content[1..]
                .split([' ', '>', '/'])
                .next()
                .unwrap_or_default();
            let is_animation = content.contains("<animate") || content.contains("<set");
            let feature = match (is_animation, content.contains("<altGlyph id")) {
                (true, _) => "animation",
                (_, true) => "altGlyph",
                _ => root.replace("defs", name).leak(),
            };
            assert!(
                notes.contains(&format!("{feature}: ignored")),
                "{name}: {notes}"
            );
        }
    }
}

#[test]
fn each_property_of_svg_1_1_is_drawn_or_reported() {
    for (name, value, effect, content) in PROPERTIES {
        let is_style = content.contains("style='@'");
        let attribute = match is_style {
            true => format!("{name}:{value}"),
            false => format!("{name}='{value}'"),
        };
        let (with, without) = (content.replace('@', &attribute), content.replace('@', ""));
        let declared = content.replace('@', &format!("style='{name}:{value}'"));
        if name == "font-family" {
            let notes = import(&with).1.join("; ");
            assert!(
                notes.contains("font No Such Font is not installed"),
                "{notes}"
            );
            continue;
        }
        assert_effect(name, effect, &with, &without);
        if !is_style && !is_number_of_presentation(value) {
            assert_effect(name, effect, &declared, &without);
        }
        if effect == Reported {
            let notes = import(&with).1.join("; ");
            assert!(notes.contains(name), "{name}: {notes}");
        }
    }
}

/// Returns whether a value is a length without a unit, which style sheets ignore.
fn is_number_of_presentation(value: &str) -> bool {
    value.parse::<f64>().is_ok()
}

#[test]
fn features_of_css_that_are_not_drawn_are_reported() {
    let cases = [
        ("style='text-shadow:1px 1px red'", "text-shadow"),
        ("style='perspective:9px'", "perspective"),
        ("style='offset-path:path(\"M0 0H9\")'", "offset-path"),
        ("style='animation:spin 1s'", "animation"),
        ("style='filter:blur(2px)'", "filter"),
        (
            "style='mask:linear-gradient(red,blue)'",
            "mask linear-gradient(red,blue)",
        ),
        (
            "style='clip-path:shape(from 0 0, line to 9px 9px)'",
            "clip-path shape",
        ),
        (
            "style='vector-effect:fixed-position'",
            "vector-effect fixed-position",
        ),
        ("style='transform:perspective(9px)'", "transform"),
        ("style='mask:url(#b) alpha'", "mask-mode alpha"),
        ("fill='url(other.svg#a)'", "fill from another file"),
    ];
    for (attribute, feature) in cases {
        let (_, notes) = import(&RECT.replace('@', attribute));
        let is_named = |note: &String| note.starts_with(feature) && note.contains("(#e)");
        assert!(notes.iter().any(is_named), "{attribute}: {notes:?}");
    }
}

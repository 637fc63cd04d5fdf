//! Reads the production code of a Rust file: everything except test code.

use std::collections::BTreeSet;
use std::path::Path;

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// A `const` item outside tests.
pub struct Constant {
    pub name: String,
    /// Its documentation as one line.
    pub docs: String,
    pub is_numeric: bool,
}

/// Production code of a file: its number of lines of code (without blank lines and comments), and
/// its constants.
pub struct ProductionCode {
    pub lines: usize,
    pub constants: Vec<Constant>,
}

impl ProductionCode {
    /// Reads a file.
    pub fn read(path: &Path) -> Self {
        let mut visitor = ProductionVisitor::default();
        visitor.visit_file(&super::parse(path));
        let text = super::read(path);
        let is_code = |line: &str| !line.is_empty() && !line.starts_with("//");
        let lines = text
            .lines()
            .enumerate()
            .filter(|(k, line)| is_code(line.trim()) && !visitor.test_lines.contains(&(k + 1)));
        Self {
            lines: lines.count(),
            constants: visitor.constants,
        }
    }
}

#[derive(Default)]
struct ProductionVisitor {
    /// Line numbers of test code, from 1.
    test_lines: BTreeSet<usize>,
    constants: Vec<Constant>,
}

impl ProductionVisitor {
    fn exclude(&mut self, span: Span) {
        self.test_lines.extend(span.start().line..=span.end().line);
    }

    fn add_constant(&mut self, name: &syn::Ident, ty: &syn::Type, attributes: &[syn::Attribute]) {
        let docs: Vec<String> = attributes.iter().filter_map(doc_line).collect();
        self.constants.push(Constant {
            name: name.to_string(),
            docs: docs.join(" "),
            is_numeric: is_numeric(ty),
        });
    }
}

impl<'ast> Visit<'ast> for ProductionVisitor {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Use(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            syn::Item::Struct(item) => &item.attrs,
            syn::Item::Enum(item) => &item.attrs,
            syn::Item::Const(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            self.exclude(item.span());
        } else {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        self.add_constant(&item.ident, &item.ty, &item.attrs);
    }

    fn visit_impl_item_const(&mut self, item: &'ast syn::ImplItemConst) {
        self.add_constant(&item.ident, &item.ty, &item.attrs);
    }
}

/// Whether attributes mark an item as compiled for tests only, by `#[cfg(test)]`.
pub fn is_test(attributes: &[syn::Attribute]) -> bool {
    let is_cfg_test = |attribute: &syn::Attribute| {
        attribute.path().is_ident("cfg")
            && (attribute.parse_args::<syn::Path>()).is_ok_and(|path| path.is_ident("test"))
    };
    attributes.iter().any(is_cfg_test)
}

fn is_numeric(ty: &syn::Type) -> bool {
    const NUMERIC: [&str; 13] = [
        "f32", "f64", "u8", "u16", "u32", "u64", "u128", "usize", "i8", "i16", "i32", "i64",
        "isize",
    ];
    matches!(ty, syn::Type::Path(path) if NUMERIC.iter().any(|name| path.path.is_ident(name)))
}

/// The text of a documentation comment's line.
fn doc_line(attribute: &syn::Attribute) -> Option<String> {
    let syn::Meta::NameValue(meta) = &attribute.meta else {
        return None;
    };
    match &meta.value {
        syn::Expr::Lit(syn::ExprLit {
            lit: syn::Lit::Str(text),
            ..
        }) if meta.path.is_ident("doc") => Some(text.value().trim().to_owned()),
        _ => None,
    }
}

//! The layers that `src/lib.rs` draws are those of the code: a module uses
//! modules above it in that list, and no files use each other in a circle.
//!
//! The code is parsed, and every path in it is followed through imports and
//! re-exports to the file that defines what it names. Methods are not: a call
//! `x.f()` names no file. Tests are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};

type Names = Vec<String>;

/// Which file uses which, by a name that says so.
type Uses<'a> = BTreeMap<&'a Path, BTreeMap<&'a Path, String>>;

/// A module: where it stands, what it defines, and what it imports.
#[derive(Default)]
struct Module {
    file: PathBuf,
    defined: BTreeSet<String>,
    /// The name in this module, and the path that it stands for.
    imported: BTreeMap<String, Names>,
    /// Paths before `::*`.
    globs: Vec<Names>,
    /// Every path that the code names, as it is written.
    named: Vec<Names>,
}

#[derive(Default)]
struct Crate(BTreeMap<Names, Module>);

fn is_test(attributes: &[syn::Attribute]) -> bool {
    let is_cfg_test = |attribute: &syn::Attribute| {
        attribute.path().is_ident("cfg")
            && (attribute.parse_args::<syn::Path>()).is_ok_and(|path| path.is_ident("test"))
    };
    attributes.iter().any(is_cfg_test)
}

impl Crate {
    fn read(root: &Path) -> Self {
        let mut found = Self::default();
        found.add_file(Vec::new(), &root.join("lib.rs"), root);
        found
    }

    /// `folder` is where the module's children lie.
    fn add_file(&mut self, name: Names, file: &Path, folder: &Path) {
        let text = fs::read_to_string(file).expect("a source file");
        let parsed = syn::parse_file(&text).expect("Rust");
        self.add_items(name, file, folder, &parsed.items);
    }

    fn add_items(&mut self, name: Names, file: &Path, folder: &Path, items: &[syn::Item]) {
        let mut module = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        for item in items {
            if let syn::Item::Mod(child) = item {
                if !is_test(&child.attrs) {
                    self.add_child(&name, file, folder, child);
                }
                continue;
            }
            module.visit_item(item);
        }
        self.0.insert(name, module);
    }

    fn add_child(&mut self, parent: &[String], file: &Path, folder: &Path, child: &syn::ItemMod) {
        let ident = child.ident.to_string();
        let name = [parent, std::slice::from_ref(&ident)].concat();
        let folder = folder.join(&ident);
        if let Some((_, items)) = &child.content {
            return self.add_items(name, file, &folder, items);
        }
        let beside = folder.with_extension("rs");
        let inside = folder.join("mod.rs");
        let file = if beside.exists() { beside } else { inside };
        self.add_file(name, &file, &folder);
    }

    /// The file that defines what a path names, seen from a module; `None`
    /// for what other crates define, and for modules themselves.
    fn file_of(&self, module: &[String], path: &[String], depth: usize) -> Option<&Path> {
        let at = self.0.get(module)?;
        let (first, rest) = path.split_first()?;
        // Imports that lead through each other end somewhere; globs may not.
        if depth > 20 {
            return None;
        }
        match first.as_str() {
            "crate" => return self.file_of(&[], rest, depth + 1),
            "self" => return self.file_of(module, rest, depth + 1),
            "super" => {
                let (_, parent) = module.split_last()?;
                return self.file_of(parent, rest, depth + 1);
            }
            _ => {}
        }
        let child = [module, std::slice::from_ref(first)].concat();
        if self.0.contains_key(&child) {
            return self.file_of(&child, rest, depth + 1);
        }
        if at.defined.contains(first) {
            return Some(&at.file);
        }
        if let Some(target) = at.imported.get(first) {
            let path = [target.as_slice(), rest].concat();
            // `use image::…` beside a module of that name means the crate.
            return (path.first() != Some(first) || target.len() > 1)
                .then(|| self.file_of(module, &path, depth + 1))?;
        }
        at.globs.iter().find_map(|glob| {
            let path = [glob.as_slice(), path].concat();
            self.file_of(module, &path, depth + 1)
        })
    }

    fn uses(&self) -> Uses<'_> {
        let mut uses = Uses::new();
        for (name, module) in &self.0 {
            let from = uses.entry(&module.file).or_default();
            let imported = module.imported.values().filter(|path| is_inside(path));
            for path in module.named.iter().chain(imported) {
                if let Some(file) = self.file_of(name, path, 0)
                    && file != module.file
                {
                    from.entry(file).or_insert_with(|| path.join("::"));
                }
            }
        }
        uses
    }
}

/// Whether an import names something of this crate.
fn is_inside(path: &[String]) -> bool {
    matches!(path[0].as_str(), "crate" | "self" | "super")
}

impl Module {
    fn import(&mut self, before: &[String], tree: &syn::UseTree) {
        let with = |ident: &syn::Ident| [before, &[ident.to_string()]].concat();
        match tree {
            syn::UseTree::Path(path) => self.import(&with(&path.ident), &path.tree),
            syn::UseTree::Group(group) => {
                group
                    .items
                    .iter()
                    .for_each(|tree| self.import(before, tree));
            }
            syn::UseTree::Glob(_) => self.globs.push(before.to_vec()),
            syn::UseTree::Name(name) if name.ident == "self" => {
                let last = before.last().cloned().unwrap_or_default();
                self.imported.insert(last, before.to_vec());
            }
            syn::UseTree::Name(name) => {
                self.imported
                    .insert(name.ident.to_string(), with(&name.ident));
            }
            syn::UseTree::Rename(rename) => {
                let path = with(&rename.ident);
                self.imported.insert(rename.rename.to_string(), path);
            }
        }
    }
}

impl<'ast> Visit<'ast> for Module {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        use syn::Item::{Const, Enum, Fn, Macro, Static, Struct, Trait, Type};
        let (attributes, ident) = match item {
            Const(item) => (&item.attrs, Some(&item.ident)),
            Enum(item) => (&item.attrs, Some(&item.ident)),
            Fn(item) => (&item.attrs, Some(&item.sig.ident)),
            Macro(item) => (&item.attrs, item.ident.as_ref()),
            Static(item) => (&item.attrs, Some(&item.ident)),
            Struct(item) => (&item.attrs, Some(&item.ident)),
            Trait(item) => (&item.attrs, Some(&item.ident)),
            Type(item) => (&item.attrs, Some(&item.ident)),
            syn::Item::Use(item) => (&item.attrs, None),
            syn::Item::Impl(item) => (&item.attrs, None),
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            return;
        }
        self.defined.extend(ident.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&[], &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|s| s.ident.to_string());
        self.named.push(names.collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, mac: &'ast syn::Macro) {
        let arguments = Punctuated::<syn::Expr, syn::Token![,]>::parse_terminated;
        if let Ok(arguments) = mac.parse_body_with(arguments) {
            // They live as long as this call only; what is named is copied.
            let mut inside = Self::default();
            arguments.iter().for_each(|e| inside.visit_expr(e));
            self.named.append(&mut inside.named);
        }
        visit::visit_macro(self, mac);
    }
}

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The modules of the list in `lib.rs`, from the top.
fn layers() -> Names {
    let text = fs::read_to_string(source().join("lib.rs")).expect("lib.rs");
    let (_, text) = text.split_once("//! # Layers").expect("a list of layers");
    let (_, text) = text.split_once("```text\n").expect("its beginning");
    let (text, _) = text.split_once("//! ```").expect("its end");
    let modules = text.lines().flat_map(|line| {
        let line = line.trim_start_matches("//! ");
        // A word or two in front of two spaces and what they mean.
        let before = line.get(..30).unwrap_or(line);
        let before = before.split('(').next().unwrap_or(before);
        before.split([',', ' ']).map(str::to_owned)
    });
    modules.filter(|name| !name.is_empty()).collect()
}

/// The top module that a file is of, as a name in the list of layers.
fn top(file: &Path) -> Option<String> {
    let inside = file.strip_prefix(source()).expect("a file of the crate");
    let first = inside.components().next()?.as_os_str();
    let name = Path::new(first).with_extension("");
    Some(name.to_string_lossy().into_owned()).filter(|name| name != "lib")
}

#[test]
fn every_module_is_in_the_list_once() {
    let found = Crate::read(&source());
    let mut layers = layers();
    layers.sort();
    let modules = found.0.keys().filter(|name| name.len() == 1);
    assert_eq!(
        layers,
        modules.map(|name| name[0].clone()).collect::<Vec<_>>()
    );
}

#[test]
fn modules_use_only_what_is_above_them() {
    let found = Crate::read(&source());
    let layers = layers();
    let height = |name: &String| layers.iter().position(|layer| layer == name);
    let mut wrong = Vec::new();
    for (from, uses) in found.uses() {
        for (to, name) in uses {
            let [Some(below), Some(above)] = [from, to].map(top) else {
                continue;
            };
            if below != above && height(&above) >= height(&below) {
                wrong.push(format!("{} uses {name}", from.display()));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "imports that go down:\n{}",
        wrong.join("\n")
    );
}

/// The files that one leads to, step by step.
fn reached<'a>(uses: &Uses<'a>, from: &'a Path) -> BTreeSet<&'a Path> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        let next = uses.get(file).into_iter().flat_map(BTreeMap::keys);
        open.extend(next.filter(|file| found.insert(**file)));
    }
    found
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let found = Crate::read(&source());
    let uses = found.uses();
    let mut arrows = Vec::new();
    for (from, to) in &uses {
        let round = to
            .iter()
            .filter(|(to, _)| reached(&uses, to).contains(from));
        let short = |file: &Path| match file.strip_prefix(source()) {
            Ok(inside) => inside.display().to_string(),
            Err(_) => file.display().to_string(),
        };
        arrows.extend(round.map(|(to, name)| format!("{} -> {}: {name}", short(from), short(to))));
    }
    assert!(
        arrows.is_empty(),
        "files in circles:\n{}",
        arrows.join("\n")
    );
}

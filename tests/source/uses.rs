//! Parses the crate's own source code: modules, their imports, and which file uses which.
//!
//! Every path in the code is followed through imports and re-exports to the file that defines the
//! item. Method calls are not followed, because `x.f()` names no file. Test code is left out.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};

use super::production::is_test;

/// Segments of a path such as `crate::geometry::Ring`.
pub type Names = Vec<String>;

/// For each file: the files that it uses, each with a path in the code that refers to it.
pub type Uses<'a> = BTreeMap<&'a Path, BTreeMap<&'a Path, String>>;

/// A module: its file, the names of the items that it defines, its imports, and the paths in its
/// code.
#[derive(Default)]
pub struct Module {
    file: PathBuf,
    defined: BTreeSet<String>,
    /// For each imported name: the path that it stands for.
    imported: BTreeMap<String, Names>,
    /// Paths of glob imports, without `::*`.
    globs: Vec<Names>,
    /// Every path in the code, as written.
    named: Vec<Names>,
}

/// All modules of a crate by their paths; the path of the crate root is empty.
#[derive(Default)]
pub struct Crate(pub BTreeMap<Names, Module>);

/// All nodes of a graph that can be reached from `from` by one or more edges.
pub fn reachable<'a, Node: Ord, Label>(
    graph: &'a BTreeMap<Node, BTreeMap<Node, Label>>,
    from: &'a Node,
) -> BTreeSet<&'a Node> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(node) = open.pop() {
        let next = graph.get(node).into_iter().flat_map(BTreeMap::keys);
        open.extend(next.filter(|node| reached.insert(*node)));
    }
    reached
}

impl Crate {
    /// Parses the crate whose `lib.rs` is in the folder `root`.
    pub fn read(root: &Path) -> Self {
        let mut found = Self::default();
        found.add_file(Vec::new(), &root.join("lib.rs"), root);
        found
    }

    /// Parses the module `name` in `file` and its children, whose files are in `folder`.
    fn add_file(&mut self, name: Names, file: &Path, folder: &Path) {
        self.add_items(name, file, folder, &super::parse(file).items);
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
        self.add_file(name, &folder.with_extension("rs"), &folder);
    }

    /// Returns the file that defines the item that `path` names in `module`; `None` for items of
    /// other crates and for modules. `depth` is the depth of the recursion.
    fn file_of(&self, module: &[String], path: &[String], depth: usize) -> Option<&Path> {
        let at = self.0.get(module)?;
        let (first, rest) = path.split_first()?;
        // Glob imports may be circular, so the depth of the recursion is bounded.
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
            // `use image::{self, …}` imports the crate `image` under its own name; its items are
            // not in this crate.
            return (path.first() != Some(first) || target.len() > 1)
                .then(|| self.file_of(module, &path, depth + 1))?;
        }
        at.globs.iter().find_map(|glob| {
            let path = [glob.as_slice(), path].concat();
            self.file_of(module, &path, depth + 1)
        })
    }

    /// Returns which files each file uses.
    pub fn uses(&self) -> Uses<'_> {
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

/// Whether the path of an import begins in this crate.
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
            // The parsed arguments of the macro live only as long as this call, too short for
            // `self`. So a temporary module collects the names.
            let mut inside = Self::default();
            arguments.iter().for_each(|e| inside.visit_expr(e));
            self.named.append(&mut inside.named);
        }
        visit::visit_macro(self, mac);
    }
}

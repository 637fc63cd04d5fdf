//! Tests that the analysis of a structure at another t allocates nothing: a counting allocator
//! counts the allocations of this thread.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use morphospace::project::gallery;
use morphospace::structure::TransitionStructure;
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

/// The system's allocator, which counts the allocations of each thread.
struct CountingAllocator;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn count() {
    // A thread that ends allocates after its counter is gone.
    let _unused = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
}

#[expect(unsafe_code, reason = "an allocator is unsafe by its nature")]
// SAFETY: all calls are handed on to the system's allocator.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[test]
fn the_analysis_of_another_t_allocates_nothing() {
    for name in ["girder-to-arch", "pratt-to-bowstring", "portal-frame"] {
        let spec = gallery::load(name)
            .expect("a project")
            .spec()
            .expect("a pair");
        let transition = Transition::build(&spec, &Silent).expect("a transition");
        let mut structure = TransitionStructure::new(&transition).expect("a structure");
        structure.solve(0.0);
        let before = ALLOCATIONS.with(Cell::get);
        let mut sum = 0.0;
        for k in 0..=20 {
            sum += structure.solve(f64::from(k) / 20.0).compliance;
        }
        assert!(sum > 0.0);
        assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0, "{name}");
    }
}

use std::cell::Cell;
use strahl_function::Workspace;

/// Calls `f` with the thread's memory for evaluating functions.
///
/// It is taken away and put back, so that a function that asks an object where it is may do the same within.
pub(super) fn with_workspace<T>(f: impl FnOnce(&mut Workspace) -> T) -> T {
    thread_local! {
        static WORKSPACE: Cell<Workspace> = Cell::default();
    }
    WORKSPACE.with(|cell| {
        let mut workspace = cell.take();
        let result = f(&mut workspace);
        cell.set(workspace);
        result
    })
}

use std::cell::Cell;
use strahl_function::Workspace;

/// Calls `f` with the thread's memory for evaluating functions.
///
/// It is removed and put back, so that a function that calls another object's function can do the same.
pub(super) fn with_workspace<T>(f: impl FnOnce(&mut Workspace) -> T) -> T {
    thread_local! {
        static WORKSPACE: Cell<Option<Box<Workspace>>> = Cell::default();
    }
    WORKSPACE.with(|cell| {
        let mut workspace = cell.take().unwrap_or_default();
        let result = f(&mut workspace);
        cell.set(Some(workspace));
        result
    })
}

use std::sync::Arc;
use strahl::prelude::RenderScene;
use strahl::tracing::Session;

/// A scene, and the threads that answer questions about it.
pub(crate) struct Asked {
    pub(crate) scene: Arc<RenderScene>,
    pub(crate) session: Session,
}

//! The server: one page, its files, and a WebSocket for each page that is open.

use crate::builtin::Builtin;
use crate::client::Client;
use crate::guard::{Guard, guard};
use crate::hub::{Defaults, Hub};
use crate::pictures::Pictures;
use crate::protocol::LONGEST_MESSAGE;
use crate::scenes::{LoadScene, Scenes};
use crate::{assets, watch};
use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use strahl::prelude::*;
use tokio::net::TcpListener;
use tokio::sync::{Notify, Semaphore};

/// What is served, and how.
pub struct ViewOptions {
    /// The port on 127.0.0.1; 0 takes a free one.
    pub port: u16,
    /// The scene's file; `None` offers those that are built in.
    pub scene: Option<PathBuf>,
    /// Reads scenes.
    pub load: LoadScene,
    /// Settings of pictures.
    pub defaults: Defaults,
    /// The threads.
    pub session: Session,
    /// Whether the page may write files of the scene.
    pub edit: bool,
    /// A program that opens a file at a line: a command with `{file}` and `{line}`, or without them a program that takes `+LINE FILE`.
    pub editor: Option<String>,
}

impl std::fmt::Debug for ViewOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ViewOptions")
            .field("port", &self.port)
            .field("scene", &self.scene)
            .field("defaults", &self.defaults)
            .finish_non_exhaustive()
    }
}

/// A server that is ready.
#[derive(Clone, Debug)]
pub struct Served {
    /// The address of the page, with the token.
    pub address: String,
    end: Arc<Notify>,
}

impl Served {
    /// Ends the server.
    pub fn end(&self) {
        self.end.notify_one();
    }
}

/// Why nothing can be served.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The port can't be used.
    #[error("cannot listen on 127.0.0.1:{port}: {error}")]
    Port {
        /// The port.
        port: u16,
        /// Why.
        error: std::io::Error,
    },
    /// The system gives no random numbers for the token.
    #[error("cannot make a token: {0}")]
    Token(#[from] getrandom::Error),
    /// Files can't be watched.
    #[error("cannot watch files: {0}")]
    Watch(#[from] notify::Error),
    /// Anything else.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// The most pages that are open at once.
const MOST_PAGES: usize = 64;

/// Serves until Ctrl-C, SIGTERM or [`Served::end`]. `ready` is called once, when the server listens.
///
/// # Errors
/// [`ServeError`].
// `ready` is no type parameter, because the server would then be compiled with the crate that calls it.
pub fn serve(options: ViewOptions, ready: &mut dyn FnMut(&Served)) -> Result<(), ServeError> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()?;
    let signals = {
        let _inside = runtime.enter();
        Signals::catch()?
    };
    // They live here, so that their files are removed at the end, whatever a page is still asking for.
    let builtin = match options.scene {
        Some(_) => None,
        None => Some(Builtin::unpack()?),
    };
    let offered = builtin.as_ref().map(Builtin::offered);
    let scene = match &offered {
        Some(scenes) => scenes.path("showcase/whitted.pov").unwrap_or_default(),
        None => options.scene.unwrap_or_default(),
    };
    let scenes = Scenes::new(options.session.clone(), options.load);
    watch::watch(&scenes)?;
    let hub = Arc::new(Hub {
        scenes,
        pictures: Pictures::new(options.session.clone()),
        session: options.session,
        offered,
        scene,
        defaults: options.defaults,
        edit: options.edit,
        editor: options.editor,
        pages: AtomicU64::new(1),
        places: Arc::new(Semaphore::new(MOST_PAGES)),
    });
    runtime.block_on(async {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, options.port));
        let listener = TcpListener::bind(address)
            .await
            .map_err(|error| ServeError::Port {
                port: options.port,
                error,
            })?;
        let port = listener.local_addr()?.port();
        let keeper = Guard::new(port)?;
        let served = Served {
            address: format!("http://127.0.0.1:{port}/?token={}", keeper.token()),
            end: Arc::default(),
        };
        let router = Router::new()
            .route("/", get(|| async { asset("index.html") }))
            .route("/ws", get(page))
            .route("/picture/{name}", get(exr))
            .route(
                "/{name}",
                get(|Path(name): Path<String>| async move { asset(&name) }),
            )
            .with_state(hub)
            .layer(from_fn_with_state(keeper, guard));
        let end = Arc::clone(&served.end);
        ready(&served);
        tokio::select! {
            outcome = async { axum::serve(listener, router).await } => outcome?,
            () = signals.any() => {}
            () = end.notified() => {}
        }
        Ok(())
    })
}

/// The signals that end the server. They are caught as soon as this is made, so it is made before there are temporary files, and before
/// anybody is told that the server listens.
struct Signals {
    #[cfg(unix)]
    interrupt: tokio::signal::unix::Signal,
    #[cfg(unix)]
    terminate: tokio::signal::unix::Signal,
    #[cfg(windows)]
    interrupt: tokio::signal::windows::CtrlC,
}

impl Signals {
    #[cfg(unix)]
    fn catch() -> std::io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};
        Ok(Self {
            interrupt: signal(SignalKind::interrupt())?,
            terminate: signal(SignalKind::terminate())?,
        })
    }

    #[cfg(windows)]
    fn catch() -> std::io::Result<Self> {
        Ok(Self {
            interrupt: tokio::signal::windows::ctrl_c()?,
        })
    }

    /// Waits for the first of them.
    async fn any(mut self) {
        #[cfg(unix)]
        tokio::select! {
            _ = self.interrupt.recv() => {}
            _ = self.terminate.recv() => {}
        }
        #[cfg(windows)]
        self.interrupt.recv().await;
    }
}

fn asset(name: &str) -> Response {
    match assets::file(name) {
        Some((media_type, file)) => ([(CONTENT_TYPE, media_type)], file.data).into_response(),
        None => (StatusCode::NOT_FOUND, "there is no such file\n").into_response(),
    }
}

/// A finished picture as a file: `picture/NUMBER.exr`.
async fn exr(State(hub): State<Arc<Hub>>, Path(name): Path<String>) -> Response {
    let number = name.strip_suffix(".exr").and_then(|n| n.parse().ok());
    let Some(picture) = number.and_then(|number| hub.pictures.finished(number)) else {
        return (
            StatusCode::NOT_FOUND,
            "there is no finished picture with this number\n",
        )
            .into_response();
    };
    match tokio::task::spawn_blocking(move || picture.exr()).await {
        Ok(Ok(file)) => ([(CONTENT_TYPE, "image/x-exr")], file).into_response(),
        Ok(Err(error)) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
        Err(error) => (StatusCode::INTERNAL_SERVER_ERROR, error.to_string()).into_response(),
    }
}

async fn page(State(hub): State<Arc<Hub>>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(place) = Arc::clone(&hub.places).try_acquire_owned() else {
        let many = "too many pages are open: close some\n";
        return (StatusCode::SERVICE_UNAVAILABLE, many).into_response();
    };
    upgrade
        .max_message_size(LONGEST_MESSAGE)
        .max_frame_size(LONGEST_MESSAGE)
        .on_upgrade(async move |socket| {
            let number = hub.pages.fetch_add(1, Ordering::Relaxed);
            Client::new(hub, number, socket).run().await;
            drop(place);
        })
}

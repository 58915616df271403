//! Pictures that pages look at: rendered once for all of them.

use crate::export::objects_of;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Instant;
use strahl::formats::image::{self, ImageError, ImageFormat, encode_picture};
use strahl::prelude::*;
use strahl::tracing::{PixelCost, PixelInfo};
use tokio::sync::mpsc::UnboundedSender;

/// What is rendered of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The colours.
    Color,
    /// Depth, normal, numbers of objects, and the like.
    Info,
    /// What each pixel costs.
    Costs,
}

/// News of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum News {
    /// A part is there; `step` is the side of the blocks that show one sample.
    Part { region: Region, step: u32 },
    /// It is finished, or has failed.
    End,
}

/// The sender of news: to whom, about the picture with which number, and what.
pub(crate) type Follower = UnboundedSender<(u64, u32, News)>;

/// A picture that is rendered or finished.
#[derive(Debug)]
pub(crate) struct Picture {
    pub(crate) number: u32,
    pub(crate) view: View,
    pub(crate) kind: Kind,
    key: String,
    stop: Arc<AtomicBool>,
    canvas: Mutex<Canvas>,
    objects: OnceLock<Vec<u32>>,
}

/// What there is of a picture.
#[derive(Debug, Default)]
pub(crate) struct Canvas {
    pub(crate) pixels: Vec<[f32; 3]>,
    pub(crate) info: Vec<PixelInfo>,
    pub(crate) costs: Vec<PixelCost>,
    pub(crate) end: Option<End>,
    /// Whether some part is there.
    pub(crate) begun: bool,
    followers: Vec<(u64, Follower)>,
}

/// How a picture has ended.
#[derive(Clone, Debug)]
pub(crate) enum End {
    Finished {
        seconds: f64,
        rays: u64,
        sha256: String,
    },
    Failed(String),
}

/// The pictures.
#[derive(Debug)]
pub(crate) struct Pictures {
    session: Session,
    all: Mutex<Vec<Arc<Picture>>>,
    numbers: AtomicU32,
}

/// How many finished pictures without a page are kept.
const KEPT: usize = 4;

/// What is said of a picture that could not be rendered because of a panic.
const BUG: &str =
    "strahl failed while it rendered this picture: this is an error of strahl, please report it";

/// The clock of [`Kind::Costs`], in nanoseconds.
fn clock() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Picture {
    pub(crate) fn canvas(&self) -> MutexGuard<'_, Canvas> {
        lock(&self.canvas)
    }

    /// The whole picture.
    pub(crate) fn region(&self) -> Region {
        Region::full(self.view.width, self.view.height)
    }

    /// Its linear colours as an EXR file with 32 bits a value.
    ///
    /// # Errors
    /// [`ImageError`]: no memory, for instance.
    pub(crate) fn exr(&self) -> Result<Vec<u8>, ImageError> {
        let pixels = self.canvas().pixels.clone();
        encoded(ImageFormat::Exr, self.view.width, self.view.height, &pixels)
    }

    /// What its pixels show, as [`objects_of`] says. It is found out once.
    ///
    /// # Errors
    /// Those of rendering.
    pub(crate) fn objects(&self, session: &Session) -> Result<&[u32], String> {
        if let Some(known) = self.objects.get() {
            return Ok(known);
        }
        let found = objects_of(session, &self.view)?;
        Ok(self.objects.get_or_init(|| found))
    }

    fn tell(&self, news: News) {
        for (who, follower) in &self.canvas().followers {
            // A page that has gone is removed by its client.
            let _ = follower.send((*who, self.number, news));
        }
    }

    fn render(&self, session: &Session) {
        let start = Instant::now();
        let output = Output {
            coarse_first: self.kind == Kind::Color,
            info: self.kind == Kind::Info,
            costs: self.kind == Kind::Costs,
            clock: (self.kind == Kind::Costs).then_some(clock),
            // Within a tile: the picture that comes after this one shall not wait for a slow one.
            stop: Some(Arc::clone(&self.stop)),
            ..Output::default()
        };
        let mut sink = |tile: &Tile<'_>| {
            let region = tile.film.region;
            {
                let canvas = &mut *self.canvas();
                canvas.begun = true;
                // It is as large as the picture.
                let _ = tile.film.write_to(&mut canvas.pixels);
                if let Some(info) = &tile.film.info {
                    put(&mut canvas.info, info, region, self.view.width);
                }
            }
            if tile.changed || tile.pass.number == 0 {
                self.tell(News::Part {
                    region,
                    step: tile.pass.step,
                });
            }
            ControlFlow::Continue(())
        };
        let rendering = || session.render(&self.view, &output, &mut sink);
        let end = match catch_unwind(AssertUnwindSafe(rendering)) {
            Ok(Ok(Outcome::Finished(rendered))) => {
                let sha256 = rendered.film.sha256();
                let canvas = &mut *self.canvas();
                canvas.costs = rendered.costs.unwrap_or_default();
                End::Finished {
                    seconds: start.elapsed().as_secs_f64(),
                    rays: rendered.rays.total(),
                    sha256,
                }
            }
            Ok(Ok(Outcome::Stopped(_))) => return,
            Ok(Err(error)) => End::Failed(error.to_string()),
            Err(_) => End::Failed(BUG.into()),
        };
        self.canvas().end = Some(end);
        self.tell(News::End);
    }
}

/// A picture as a file in memory.
///
/// # Errors
/// [`ImageError`]: no memory, for instance.
pub(crate) fn encoded(
    format: ImageFormat,
    width: u32,
    height: u32,
    pixels: &[[f32; 3]],
) -> Result<Vec<u8>, ImageError> {
    let mut picture = image::Picture::new(width, height, pixels);
    let software = concat!("strahl ", env!("CARGO_PKG_VERSION"));
    picture.metadata = vec![("Software".into(), software.into())];
    let mut file = std::io::Cursor::new(vec![]);
    encode_picture(&mut file, format, &picture, &WriteOptions::default())?;
    Ok(file.into_inner())
}

/// Writes the values of a region.
fn put<T: Copy>(all: &mut [T], part: &[T], region: Region, width: u32) {
    let rows = part.chunks_exact(region.width.max(1) as usize);
    for (y, row) in (region.y..).zip(rows) {
        let start = y as usize * width as usize + region.x as usize;
        if let Some(place) = all.get_mut(start..start + row.len()) {
            place.copy_from_slice(row);
        }
    }
}

const NO_INFO: PixelInfo = PixelInfo {
    depth: f32::INFINITY,
    normal: [0.0; 3],
    position: [0.0; 3],
    object: 0,
    material: 0,
    tree_depth: 0,
    tests: 0,
};

impl Pictures {
    pub(crate) fn new(session: Session) -> Arc<Self> {
        Arc::new(Self {
            session,
            all: Mutex::default(),
            numbers: AtomicU32::new(1),
        })
    }

    /// The picture of a view of a scene, which no other scene has the name of. The follower `who` gets its news from now on; what there is of the
    /// picture already it must look up.
    pub(crate) fn follow(
        &self,
        scene: &str,
        view: &View,
        kind: Kind,
        who: u64,
        follower: &Follower,
    ) -> Arc<Picture> {
        let key = format!(
            "{scene} {kind:?} {}x{} {:?} {:?} {} {:?}",
            view.width, view.height, view.camera, view.sampling, view.seed, view.trace
        );
        let mut all = lock(&self.all);
        if let Some(known) = all.iter().find(|picture| picture.key == key) {
            known.canvas().followers.push((who, follower.clone()));
            return Arc::clone(known);
        }
        let pixels = view.width as usize * view.height as usize;
        let picture = Arc::new(Picture {
            number: self.numbers.fetch_add(1, Ordering::Relaxed),
            view: view.clone(),
            kind,
            key,
            stop: Arc::default(),
            canvas: Mutex::new(Canvas {
                pixels: vec![[0.0; 3]; pixels],
                info: vec![NO_INFO; if kind == Kind::Info { pixels } else { 0 }],
                followers: vec![(who, follower.clone())],
                ..Canvas::default()
            }),
            objects: OnceLock::new(),
        });
        let (session, rendered) = (self.session.clone(), Arc::clone(&picture));
        let thread = std::thread::Builder::new().name("strahl picture".into());
        if let Err(error) = thread.spawn(move || rendered.render(&session)) {
            picture.canvas().end = Some(End::Failed(error.to_string()));
        }
        all.push(Arc::clone(&picture));
        picture
    }

    /// The follower `who` wants no more news of a picture. A picture without followers is stopped; some finished ones are kept.
    pub(crate) fn leave(&self, picture: &Arc<Picture>, who: u64) {
        let mut all = lock(&self.all);
        {
            let canvas = &mut *picture.canvas();
            if let Some(index) = canvas.followers.iter().position(|(id, _)| *id == who) {
                canvas.followers.swap_remove(index);
            }
            if canvas.followers.is_empty() && canvas.end.is_none() {
                picture.stop.store(true, Ordering::Relaxed);
            }
        }
        all.retain(|picture| !picture.stop.load(Ordering::Relaxed));
        let idle = |picture: &Arc<Picture>| picture.canvas().followers.is_empty();
        while all.iter().filter(|p| idle(p)).count() > KEPT {
            let Some(oldest) = all.iter().position(idle) else {
                break;
            };
            all.remove(oldest);
        }
    }

    /// The finished picture with this number.
    pub(crate) fn finished(&self, number: u32) -> Option<Arc<Picture>> {
        let all = lock(&self.all);
        let found = all.iter().find(|picture| picture.number == number)?;
        let finished = matches!(found.canvas().end, Some(End::Finished { .. }));
        finished.then(|| Arc::clone(found))
    }

    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        lock(&self.all).len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

    fn view(session: &Session, size: u32) -> View {
        let scene = crate::testing::ball("ball");
        let (scene, _) = session.compile(&scene, &CompileOptions::default()).unwrap();
        scene.view(size, size)
    }

    fn wait(news: &mut UnboundedReceiver<(u64, u32, News)>) {
        while news.blocking_recv().unwrap().2 != News::End {}
    }

    #[test]
    fn two_pages_share_a_picture_and_it_is_that_of_a_session() {
        let session = Session::new(Threads::Count(2)).unwrap();
        let pictures = Pictures::new(session.clone());
        let view = view(&session, 100);
        let (first, mut news) = unbounded_channel();
        let (second, mut more) = unbounded_channel();
        let a = pictures.follow("1", &view, Kind::Color, 1, &first);
        let b = pictures.follow("1", &view, Kind::Color, 2, &second);
        assert!(Arc::ptr_eq(&a, &b));
        wait(&mut news);
        wait(&mut more);
        let expected = session.picture(&view, &Output::default()).unwrap();
        assert_eq!(a.canvas().pixels, expected.film.pixels);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        std::fs::write(&path, pictures.finished(a.number).unwrap().exr().unwrap()).unwrap();
        let file = image::read_exr(&path).unwrap();
        for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
            let values = expected.film.pixels.iter().map(|p| p[channel]).collect();
            assert_eq!(file.channels[name], image::LayerData::F32(values));
        }
        let c = pictures.follow("2", &view, Kind::Color, 1, &first);
        assert!(!Arc::ptr_eq(&a, &c));
    }

    #[test]
    fn a_picture_that_nobody_looks_at_is_stopped() {
        let session = Session::new(Threads::Count(1)).unwrap();
        let pictures = Pictures::new(session.clone());
        // A tile takes seconds.
        let view = view(&session, 3000).with_sampling(Sampling::Grid(64));
        let (sender, _news) = unbounded_channel();
        let picture = pictures.follow("1", &view, Kind::Color, 1, &sender);
        pictures.leave(&picture, 1);
        assert_eq!(pictures.count(), 0);
        // The thread of the picture holds it until it has stopped.
        let start = Instant::now();
        while Arc::strong_count(&picture) > 1 {
            assert!(start.elapsed().as_secs() < 2, "it stops within a tile");
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert!(picture.canvas().end.is_none());
    }

    #[test]
    fn only_some_finished_pictures_are_kept() {
        let session = Session::new(Threads::Count(1)).unwrap();
        let pictures = Pictures::new(session.clone());
        let view = view(&session, 8);
        let (sender, mut news) = unbounded_channel();
        for scene in 0..10 {
            let picture = pictures.follow(&scene.to_string(), &view, Kind::Info, 1, &sender);
            wait(&mut news);
            assert!(picture.canvas().info.iter().any(|info| info.object == 1));
            pictures.leave(&picture, 1);
        }
        assert_eq!(pictures.count(), KEPT);
    }
}

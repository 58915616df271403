//! Values that are computed once per scene.

use super::Prober;
use crate::scene::RenderScene;
use crate::session::Session;
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Computes a value once per scene, before its pictures: radiosity at points, a map of photons.
///
/// The work is divided into generations, and each of these into parts, which threads compute in any order. They are merged in the order
/// of their numbers before the next generation begins, so the value has the same bits for any number of threads.
pub trait Prepass: Sync {
    /// The value.
    type Value: Sync + Send;
    /// What a part contributes to it.
    type Part: Send;

    /// The value before the first generation.
    fn begin(&self, scene: &RenderScene) -> Self::Value;

    /// The number of parts of a generation, which are counted from 0; no parts end the work.
    fn parts(&self, value: &Self::Value, generation: u32) -> u32;

    /// Computes a part; `at` is the number of the generation and that of the part. It must depend on the value, the numbers and the
    /// scene only.
    fn part(&self, prober: &mut Prober<'_>, value: &Self::Value, at: (u32, u32)) -> Self::Part;

    /// Adds a part to the value; called in the order of generations and parts.
    fn merge(&self, value: &mut Self::Value, part: Self::Part);
}

impl Session {
    /// Computes the value of a prepass.
    pub fn prepass<P: Prepass>(&self, scene: &RenderScene, prepass: &P) -> P::Value {
        let mut value = prepass.begin(scene);
        for generation in 0.. {
            let count = prepass.parts(&value, generation);
            if count == 0 {
                break;
            }
            let parts: Vec<P::Part> = self.pool.install(|| {
                (0..count)
                    .into_par_iter()
                    .map_init(
                        || scene.prober(),
                        |prober, part| prepass.part(prober, &value, (generation, part)),
                    )
                    .collect()
            });
            for part in parts {
                prepass.merge(&mut value, part);
            }
        }
        value
    }
}

/// The file of a value.
#[derive(Serialize, Deserialize)]
struct Saved<V> {
    /// The name of the prepass.
    prepass: String,
    /// The scene and the settings it was computed for.
    key: String,
    value: V,
}

/// Why a value could not be read.
#[derive(Debug, thiserror::Error)]
pub enum PrepassError {
    /// It is no value of such a prepass.
    #[error("no values of a prepass: {0}")]
    Format(#[from] serde_json::Error),
    /// It was computed by another prepass, or for another scene.
    #[error("the values are those of `{found}`, and `{expected}` is needed: compute them again")]
    Other {
        /// Prepass and key of the value.
        found: String,
        /// What was asked for.
        expected: String,
    },
}

/// A value as text, for [`load_prepass`]: `name` is the name of the prepass, `key` stands for the scene and the settings.
///
/// # Errors
/// [`PrepassError::Format`] if the value can't be serialised.
pub fn save_prepass<V: Serialize>(
    name: &str,
    key: &str,
    value: &V,
) -> Result<String, PrepassError> {
    Ok(serde_json::to_string(&Saved {
        prepass: name.to_owned(),
        key: key.to_owned(),
        value,
    })?)
}

/// Reads a value again, with the same bits (of finite numbers).
///
/// # Errors
/// [`PrepassError`] if the text is none of this prepass, or the key is another one.
pub fn load_prepass<V: DeserializeOwned>(
    name: &str,
    key: &str,
    text: &str,
) -> Result<V, PrepassError> {
    let saved: Saved<V> = serde_json::from_str(text)?;
    if saved.prepass == name && saved.key == key {
        return Ok(saved.value);
    }
    Err(PrepassError::Other {
        found: format!("{} of {}", saved.prepass, saved.key),
        expected: format!("{name} of {key}"),
    })
}

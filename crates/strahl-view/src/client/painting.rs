//! Pixels and news of pictures, sent to the page.

use super::{Client, Gone};
use crate::colors::{Look, srgb8};
use crate::pictures::{End, Kind, News, Picture};
use crate::protocol::{COLORS, Channel, LINEAR, LONGEST_SIDE, Slot, header};
use axum::extract::ws::Message;
use serde_json::json;
use strahl::prelude::*;

/// The most pixels whose linear values are sent at once.
const MOST_LINEAR: u64 = 1 << 16;

impl Client {
    /// Passes news of a picture on to the page.
    pub(super) async fn tell(&mut self, who: u64, number: u32, news: News) -> Result<(), Gone> {
        let shown = self
            .slots
            .iter_mut()
            .find(|(slot, _)| self.number * 4 + **slot as u64 == who);
        let Some((&slot, shown)) = shown else {
            return Ok(());
        };
        let Some(picture) = shown.picture.clone().filter(|p| p.number == number) else {
            return Ok(());
        };
        let channel = shown.look.channel;
        // The scale of counts is known at the end.
        let counts =
            picture.kind == Kind::Costs || matches!(channel, Channel::Levels | Channel::Tests);
        match news {
            News::Part { .. } if counts => Ok(()),
            News::Part { region, step } => {
                let look = shown.look;
                self.part(&picture, region, step, &look).await
            }
            News::End => {
                if counts {
                    self.scale(slot, &picture).await?;
                }
                let end = picture.canvas().end.clone();
                let scale = self.slots.get(&slot).map(|shown| shown.look.scale);
                let message = match end {
                    Some(End::Finished {
                        seconds,
                        rays,
                        sha256,
                    }) => json!({
                        "type": "done", "slot": slot, "picture": number, "seconds": seconds, "rays": rays, "sha256": sha256, "scale": scale,
                    }),
                    Some(End::Failed(message)) => {
                        json!({ "type": "error", "slot": slot, "message": message })
                    }
                    None => return Ok(()),
                };
                self.send(&message).await
            }
        }
    }

    /// Finds the scale of counts, and sends the picture with it. A second picture of the same counts gets the same scale, so that equal colours
    /// mean equal numbers.
    async fn scale(&mut self, slot: Slot, picture: &Picture) -> Result<(), Gone> {
        let partner = match slot {
            Slot::Main => Some(Slot::Side),
            Slot::Side => Some(Slot::Main),
            Slot::Space => None,
        };
        let Some(channel) = self.slots.get(&slot).map(|shown| shown.look.channel) else {
            return Ok(());
        };
        let mut scale = channel.scale(picture);
        let other = partner.and_then(|partner| {
            let shown = self.slots.get(&partner)?;
            let other = shown.picture.clone()?;
            let ended = matches!(other.canvas().end, Some(End::Finished { .. }));
            let alike = shown.look.channel == channel && ended;
            alike.then_some((partner, other, shown.look.scale))
        });
        if let Some((partner, other, known)) = other {
            scale = scale.max(channel.scale(&other));
            if known != scale
                && let Some(shown) = self.slots.get_mut(&partner)
            {
                shown.look.scale = scale;
                let look = shown.look;
                self.part(&other, other.region(), 1, &look).await?;
                self.send(&json!({ "type": "scale", "slot": partner, "scale": scale }))
                    .await?;
            }
        }
        if let Some(shown) = self.slots.get_mut(&slot) {
            shown.look.scale = scale;
            let look = shown.look;
            self.part(picture, picture.region(), 1, &look).await?;
        }
        Ok(())
    }

    /// Sends the colours of a part of a picture.
    async fn part(
        &mut self,
        picture: &Picture,
        region: Region,
        step: u32,
        look: &Look,
    ) -> Result<(), Gone> {
        let mut message = header(COLORS, picture.number, region, step);
        message.extend(srgb8(picture, region, step, look));
        self.put(Message::Binary(message.into())).await
    }

    /// Sends the linear values of a part of a picture.
    pub(super) async fn linear(
        &mut self,
        slot: Slot,
        [x, y, width, height]: [u32; 4],
    ) -> Result<(), Gone> {
        let picture = self.picture(slot);
        let asked = Region {
            x,
            y,
            width: width.min(LONGEST_SIDE),
            height: height.min(LONGEST_SIDE),
        };
        let fits = x < LONGEST_SIDE && y < LONGEST_SIDE;
        let region = picture
            .as_ref()
            .filter(|_| fits)
            .and_then(|p| p.region().intersection(&asked));
        let (Some(picture), Some(region)) = (picture, region) else {
            return self.complain("there is no such part of the picture").await;
        };
        if region.pixels() > MOST_LINEAR {
            return self.complain("the part of the picture is too large").await;
        }
        let mut message = header(LINEAR, picture.number, region, 1);
        {
            let canvas = picture.canvas();
            for y in region.y..region.y + region.height {
                let start = y as usize * picture.view.width as usize + region.x as usize;
                let row = canvas.pixels.get(start..start + region.width as usize);
                for value in row.unwrap_or_default().as_flattened() {
                    message.extend(value.to_le_bytes());
                }
            }
        }
        self.put(Message::Binary(message.into())).await
    }
}

use super::{PResult, Parser, Place};
use crate::source::Stream;

impl Parser<'_> {
    /// Passes a message of the scene to the caller.
    pub(crate) fn send(&mut self, place: Place, stream: Stream, text: &str) -> PResult<()> {
        self.message_bytes = self.message_bytes.saturating_add(text.len() as u64);
        let limit = self.options.limits.written_bytes;
        if self.message_bytes > limit {
            let message = format!("the messages of the scene are longer than {limit} bytes");
            return Err(self.fail_fatally(
                place,
                message,
                "write less, or raise the limit: `--limit written_bytes=N`",
            ));
        }
        self.host.message(stream, text);
        Ok(())
    }
}

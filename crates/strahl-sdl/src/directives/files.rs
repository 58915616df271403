use crate::parser::{PResult, Parser};

impl Parser<'_> {
    pub(super) fn fopen(&mut self) -> PResult<()> {
        let place = self.place();
        Err(self.fail(
            place,
            "writing and reading files by `#fopen` is not supported",
        ))
    }
    pub(super) fn fclose(&mut self) -> PResult<()> {
        self.fopen()
    }
    pub(super) fn read(&mut self) -> PResult<()> {
        self.fopen()
    }
    pub(super) fn write(&mut self) -> PResult<()> {
        self.fopen()
    }
}

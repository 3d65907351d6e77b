//! Pictures made by the program around this library: bent bitmaps and gradients.

use pathwarp::kurbo::Rect;
use std::error::Error;

/// A bent bitmap, or a picture of a bent gradient.
#[derive(Debug, Clone, PartialEq)]
pub struct BentImage {
    /// Content of a PNG file.
    pub png: Vec<u8>,
    /// Position in the requested user space.
    pub area: Rect,
}

/// The reason why a bitmap or gradient cannot be bent.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct PictureError(Box<dyn Error + Send + Sync>);

impl PictureError {
    /// Wraps another error, or a message.
    pub fn new(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(error.into())
    }
}

impl From<String> for PictureError {
    fn from(message: String) -> Self {
        Self::new(message)
    }
}

impl From<&str> for PictureError {
    fn from(message: &str) -> Self {
        Self::new(message)
    }
}

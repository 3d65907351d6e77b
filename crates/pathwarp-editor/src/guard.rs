//! Access control: the server answers only a browser on this computer that knows the token, and only the server's page.
//!
//! The token in the address keeps out other users of the computer. The `Host` header keeps out pages that reach the server by a name of
//! theirs (DNS rebinding). `Origin` keeps out the scripts of other pages, which browsers let open WebSockets anywhere.

use crate::draft;
use crate::host::Host;
use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Length of the token in bytes, too long to guess.
const TOKEN_BYTES: usize = 24;

/// Conditions for answering a request.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Guard {
    token: String,
    pub(crate) port: u16,
}

/// The reason for a refusal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// The host name is not this computer's.
    Host,
    /// The request comes from another server's page.
    Origin,
    /// The address lacks the token.
    Token,
}

impl Guard {
    /// Creates a guard with a new token for the server at `port`.
    pub(crate) fn new(port: u16) -> io::Result<Self> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes).map_err(|e| io::Error::other(e.to_string()))?;
        Ok(Self { token: URL_SAFE_NO_PAD.encode(bytes), port })
    }

    /// Returns the file that stores the guard of the last run on a drawing, named after the drawing's path only.
    fn file(state: &Path, drawing: &Path) -> PathBuf {
        state.join("addresses").join(draft::key(drawing, &[]) + ".json")
    }

    /// Reads the guard of the last run on a drawing.
    pub(crate) fn last(state: &Path, drawing: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(Self::file(state, drawing)).ok()?;
        let guard: Self = serde_json::from_str(&text).ok()?;
        // A truncated file holds no valid token.
        URL_SAFE_NO_PAD.decode(&guard.token).is_ok_and(|t| t.len() == TOKEN_BYTES).then_some(guard)
    }

    /// Stores the guard for the next run on a drawing, to which a page that is still open then connects.
    pub(crate) fn keep(&self, host: &dyn Host, state: &Path, drawing: &Path) -> Result<(), String> {
        let text = serde_json::to_string(self).map_err(|e| e.to_string())?;
        draft::write(host, &Self::file(state, drawing), text.as_bytes())
    }

    /// Returns a hash of the token and a question of the page, by which the page, which knows the token, recognises its server.
    pub(crate) fn proof(&self, question: &str) -> String {
        draft::sha256_hex(&[self.token.as_bytes(), question.as_bytes()])
    }

    /// Returns the address of the page.
    pub(crate) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    /// Checks the host and, if the browser names one, the origin.
    pub(crate) fn check_host_and_origin(&self, host: Option<&str>, origin: Option<&str>) -> Result<(), Refusal> {
        let port = self.port;
        let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        let is_own = |host: &str| own.iter().any(|o| o.eq_ignore_ascii_case(host));
        if !host.is_some_and(is_own) {
            return Err(Refusal::Host);
        }
        match origin {
            None => Ok(()),
            Some(origin) if origin.strip_prefix("http://").is_some_and(is_own) => Ok(()),
            Some(_) => Err(Refusal::Origin),
        }
    }

    /// Checks the token in the query of an address.
    pub(crate) fn check_token(&self, query: &str) -> Result<(), Refusal> {
        let given = query.split('&').find_map(|pair| pair.strip_prefix("token="));
        if given.is_some_and(|g| same(g.as_bytes(), self.token.as_bytes())) { Ok(()) } else { Err(Refusal::Token) }
    }
}

/// Compares in a time that does not depend on the position of the first difference.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |sum, (x, y)| sum | (x ^ y)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_own_page_with_the_token_passes() {
        let guard = Guard::new(4000).unwrap();
        let check = |host, origin| guard.check_host_and_origin(host, origin);
        assert_eq!(check(Some("127.0.0.1:4000"), None), Ok(()));
        assert_eq!(check(Some("localhost:4000"), Some("http://localhost:4000")), Ok(()));
        assert_eq!(check(Some("127.0.0.1:4000"), Some("http://127.0.0.1:4001")), Err(Refusal::Origin));
        assert_eq!(check(Some("127.0.0.1:4000"), Some("null")), Err(Refusal::Origin));
        assert_eq!(check(Some("rebound.example:4000"), None), Err(Refusal::Host));
        assert_eq!(check(None, None), Err(Refusal::Host));
        let address = guard.address();
        let (_, query) = address.split_once('?').unwrap();
        assert_eq!(guard.check_token(query), Ok(()));
        assert_eq!(guard.check_token(&query[..query.len() - 1]), Err(Refusal::Token));
        assert_eq!(guard.check_token(""), Err(Refusal::Token));
        assert_ne!(Guard::new(4000).unwrap().address(), address);
    }
}

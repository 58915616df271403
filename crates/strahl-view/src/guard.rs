//! Who may ask: requests of this machine's own pages that know the token.

use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, COOKIE, HOST, HeaderMap, HeaderValue, ORIGIN,
    REFERRER_POLICY, SET_COOKIE, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{StatusCode, Uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

/// The token and the cookie that holds it.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    token: Arc<str>,
    cookie: Arc<str>,
}

/// Nothing from other hosts, and no script or style inside of the page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

impl Guard {
    /// A guard with a new random token, for a server at this port.
    pub(crate) fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        let token: String = bytes.iter().map(|b| format!("{b:02x}")).collect();
        Ok(Self {
            token: token.into(),
            // Browsers send a cookie to all ports of a host.
            cookie: format!("strahl-{port}").into(),
        })
    }

    pub(crate) fn token(&self) -> &str {
        &self.token
    }

    /// Whether the request knows the token, from its address or its cookie.
    fn knows(&self, uri: &Uri, headers: &HeaderMap) -> bool {
        self.in_address(uri)
            || headers
                .get_all(COOKIE)
                .iter()
                .filter_map(|value| value.to_str().ok())
                .flat_map(|all| all.split(';'))
                .filter_map(|one| one.trim().split_once('='))
                .any(|(name, value)| name == &*self.cookie && equal(value, &self.token))
    }

    fn in_address(&self, uri: &Uri) -> bool {
        let words = uri.query().unwrap_or("").split('&');
        let mut tokens = words.filter_map(|word| word.strip_prefix("token="));
        tokens.any(|token| equal(token, &self.token))
    }
}

/// Compares without telling by its time how much is equal.
fn equal(a: &str, b: &str) -> bool {
    a.len() == b.len()
        && a.bytes()
            .zip(b.bytes())
            .fold(0, |all, (a, b)| all | (a ^ b))
            == 0
}

/// Whether a host is this machine under a name that no other machine's name server can give it.
fn is_local(host: &str) -> bool {
    let port_of = |rest: &str| rest.is_empty() || rest.starts_with(':');
    ["127.0.0.1", "localhost", "[::1]"]
        .iter()
        .any(|name| host.strip_prefix(name).is_some_and(port_of))
}

/// Refuses strangers, and adds the headers of all answers.
pub(crate) async fn guard(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    let one = |name| headers.get(name).and_then(|value| value.to_str().ok());
    let host = one(HOST).unwrap_or("");
    let own = |origin: &str| origin == format!("http://{host}");
    let mut response = if !is_local(host) {
        refused("this server answers only to 127.0.0.1 and localhost\n")
    } else if headers.contains_key(ORIGIN) && !one(ORIGIN).is_some_and(own) {
        refused("this server answers only to its own page\n")
    } else if !guard.knows(request.uri(), headers) {
        refused("the token is missing or wrong: use the address that `strahl view` has printed\n")
    } else {
        let fresh = guard.in_address(request.uri());
        let mut response = next.run(request).await;
        if fresh {
            let cookie = format!(
                "{}={}; Path=/; HttpOnly; SameSite=Strict",
                guard.cookie, guard.token
            );
            if let Ok(value) = HeaderValue::from_str(&cookie) {
                response.headers_mut().insert(SET_COOKIE, value);
            }
        }
        response
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

fn refused(why: &'static str) -> Response {
    (StatusCode::FORBIDDEN, why).into_response()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_local() {
        for good in ["127.0.0.1:8000", "localhost", "localhost:1", "[::1]:80"] {
            assert!(is_local(good), "{good}");
        }
        for bad in [
            "",
            "127.0.0.1.example.org",
            "localhost.example.org:80",
            "example.org",
            "127.0.0.12",
        ] {
            assert!(!is_local(bad), "{bad}");
        }
    }

    #[test]
    fn tokens_are_compared_whole() {
        assert!(
            equal("abc", "abc") && !equal("ab", "abc") && !equal("abd", "abc") && !equal("", "a")
        );
    }
}

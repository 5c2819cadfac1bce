//! The client's messages, read on a thread of their own, so that a request can be cancelled while it is worked on.

use std::collections::HashMap;
use std::io::{BufRead, Read};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use pliant_mesh::Cancel;
use serde_json::Value;

use super::message::{self, Fault, INVALID_REQUEST, Id, Message};

/// The most bytes of one message: an edit may have a number for each vertex of a large scan.
const MOST_BYTES: u64 = 256 * 1024 * 1024;

/// A message as the server takes it.
pub enum Incoming {
    /// A request, and the flag that its cancellation raises.
    Request {
        id: Id,
        method: String,
        params: Value,
        cancel: Cancel,
    },
    /// A message that is refused, with the id to answer.
    Refused(Id, Fault),
}

/// The requests that are waiting or worked on, by their ids.
#[derive(Clone, Default)]
pub struct UnderWay(Arc<Mutex<HashMap<String, Cancel>>>);

impl UnderWay {
    fn begin(&self, id: &Id) -> Cancel {
        let cancel = Cancel::new();
        let mut requests = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        requests.insert(id.to_string(), cancel.clone());
        cancel
    }

    fn cancel(&self, id: &Id) {
        let requests = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(cancel) = requests.get(&id.to_string()) {
            cancel.cancel();
        }
    }

    /// Forgets a request that was answered.
    pub fn end(&self, id: &Id) {
        let mut requests = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        requests.remove(&id.to_string());
    }
}

/// Reads messages until the input ends; the receiver then gives what was read before.
pub fn listen(input: impl BufRead + Send + 'static) -> (Receiver<Incoming>, UnderWay) {
    let (sender, receiver) = channel();
    let under_way = UnderWay::default();
    let known = under_way.clone();
    std::thread::spawn(move || read_all(input, &sender, &known));
    (receiver, under_way)
}

fn read_all(mut input: impl BufRead, sender: &Sender<Incoming>, under_way: &UnderWay) {
    let mut line = Vec::new();
    loop {
        line.clear();
        match input.by_ref().take(MOST_BYTES).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let is_whole = line.ends_with(b"\n") || (line.len() as u64) < MOST_BYTES;
        let incoming = if is_whole {
            incoming(&line, under_way)
        } else {
            if skip_line(&mut input).is_err() {
                return;
            }
            let said = format!("the message is longer than {MOST_BYTES} bytes: put large edits into a file");
            Some(Incoming::Refused(Value::Null, Fault::new(INVALID_REQUEST, said)))
        };
        // The server has ended if nobody receives.
        if incoming.is_some_and(|incoming| sender.send(incoming).is_err()) {
            return;
        }
    }
}

/// Reads to the end of a line without keeping it.
fn skip_line(input: &mut impl BufRead) -> std::io::Result<()> {
    loop {
        let read = input.fill_buf()?;
        if read.is_empty() {
            return Ok(());
        }
        let end = read.iter().position(|&byte| byte == b'\n');
        let length = end.map_or(read.len(), |end| end + 1);
        input.consume(length);
        if end.is_some() {
            return Ok(());
        }
    }
}

/// The message of a line that needs an answer; cancels the request that a notification cancels.
fn incoming(line: &[u8], under_way: &UnderWay) -> Option<Incoming> {
    if line.trim_ascii().is_empty() {
        return None;
    }
    match message::message(line) {
        Ok(Message::Request { id, method, params }) => {
            let cancel = under_way.begin(&id);
            Some(Incoming::Request {
                id,
                method,
                params,
                cancel,
            })
        }
        Ok(Message::Notification { method, params }) => {
            if method == "notifications/cancelled" {
                under_way.cancel(&params["requestId"]);
            }
            None
        }
        Ok(Message::Answer) => None,
        Err((id, fault)) => Some(Incoming::Refused(id, fault)),
    }
}

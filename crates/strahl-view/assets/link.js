// The connection to the server.

// How long it waits before it tries again, in milliseconds.
const AGAIN = 2000;

export class Link {
  constructor(handlers) {
    this.handlers = handlers;
    this.waiting = new Map();
    this.count = 0;
    this.socket = open();
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = (event) => this.receive(event.data);
    this.socket.onclose = () => this.lost();
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  // Asks a question; the promise has its answer, or fails with the server's reason.
  ask(message) {
    const id = (this.count += 1);
    return new Promise((resolve, reject) => {
      if (this.socket.readyState !== WebSocket.OPEN) {
        reject(new Error("not connected"));
        return;
      }
      this.waiting.set(id, { resolve, reject });
      this.send({ ...message, id });
    });
  }

  receive(data) {
    if (data instanceof ArrayBuffer) {
      const [kind, picture, x, y, width, height, step, extra] = new Uint32Array(data, 0, 8);
      this.handlers.binary({ kind, picture, x, y, width, height, step, extra }, data.slice(32));
      return;
    }
    const message = JSON.parse(data);
    if (message.type !== "reply") {
      this.handlers[message.type]?.(message);
      return;
    }
    const waiting = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.problem !== undefined) waiting?.reject(new Error(message.problem));
    else waiting?.resolve(message.value);
  }

  // Nothing is answered any more. The page begins anew when the server is there again, after a pause of the network for instance; its address has kept
  // what it shows.
  lost() {
    for (const { reject } of this.waiting.values()) reject(new Error("not connected"));
    this.waiting.clear();
    this.handlers.lost();
    const again = () => {
      const socket = open();
      socket.onopen = () => this.handlers.again();
      socket.onerror = () => setTimeout(again, AGAIN);
    };
    setTimeout(again, AGAIN);
  }
}

function open() {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  return new WebSocket(`${scheme}://${location.host}/ws`);
}

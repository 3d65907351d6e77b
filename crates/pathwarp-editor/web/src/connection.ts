// The socket: requests with their answers, and messages from the server.

import type { Answer } from "./types";

type Waiting = { resolve: (answer: Answer) => void; reject: (problem: Error) => void };

/** The pause before the page looks for the program again, and the longest wait for its answer, in ms. */
const RETRY = 700;
const PATIENCE = 5000;
/** The token that permits the connection. */
const TOKEN = new URLSearchParams(location.search).get("token") ?? "";

/** The server refuses a request. The message is for the user. */
export class Refused extends Error {}
/** The server does not answer. */
export class Gone extends Error {}

export class Connection {
  private socket: WebSocket | null = null;
  private waiting = new Map<number, Waiting>();
  private next = 1;
  private isStopped = false;
  /** The requests whose answers are awaited, as opposed to thumbnails. */
  private urgent = new Set<number>();
  onBusy: (isBusy: boolean) => void = () => {};
  /** The length of the last message from the server. */
  size = 0;

  constructor(
    private onOpen: () => void,
    private onGone: () => void,
    private onEvent: (answer: Answer) => void,
  ) {
    this.connect();
  }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/socket?token=${TOKEN}`);
    socket.onopen = () => {
      this.socket = socket;
      history.replaceState(null, "", `/?token=${TOKEN}`);
      this.onOpen();
    };
    socket.onmessage = (message) => {
      this.size = (message.data as string).length;
      this.take(JSON.parse(message.data as string) as Answer);
    };
    socket.onclose = () => {
      this.socket = null;
      for (const { reject } of this.waiting.values()) reject(new Gone("pathwarp has ended"));
      this.waiting.clear();
      this.urgent.clear();
      this.onBusy(false);
      // Reloading the page would send the token to whoever listens there now.
      history.replaceState(null, "", "/");
      this.onGone();
      this.look();
    };
  }

  /** Waits for the program, and connects. */
  private look(): void {
    setTimeout(async () => {
      if (this.isStopped) return;
      if (await isProgram()) this.connect();
      else this.look();
    }, RETRY);
  }

  /** Stops connecting. */
  stop(): void {
    this.isStopped = true;
  }

  private take(answer: Answer): void {
    if (answer.id === undefined) return this.onEvent(answer);
    const waiting = this.waiting.get(answer.id);
    this.waiting.delete(answer.id);
    if (this.urgent.delete(answer.id) && this.urgent.size === 0) this.onBusy(false);
    if (answer.error === undefined) waiting?.resolve(answer);
    else waiting?.reject(new Refused(answer.error));
  }

  /** `true` while an answer is awaited. */
  get isBusy(): boolean {
    return this.urgent.size > 0;
  }

  /** Sends a request. */
  ask(request: Record<string, unknown> & { do: string }): Promise<Answer> {
    const { socket } = this;
    if (!socket) return Promise.reject(new Gone("pathwarp has ended"));
    const id = this.next++;
    if (request.do !== "thumbnail") {
      this.urgent.add(id);
      this.onBusy(true);
    }
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      socket.send(JSON.stringify({ ...request, id }));
    });
  }
}

/** Returns `true` if the program listens there, and nobody else: it proves that it knows the token, which is not sent. */
async function isProgram(): Promise<boolean> {
  const question = crypto.randomUUID();
  try {
    const answer = await fetch(`/proof?${question}`, { signal: AbortSignal.timeout(PATIENCE) });
    const sum = await crypto.subtle.digest("SHA-256", new TextEncoder().encode(TOKEN + question));
    return (await answer.text()) === Array.from(new Uint8Array(sum), (byte) => byte.toString(16).padStart(2, "0")).join("");
  } catch {
    return false;
  }
}

/** The way to a rig's live stream: opens it with a fresh ticket, acknowledges, notices silence, and
 * comes back by itself. What the messages mean is the caller's business. */
import { backoffDelay } from './backoff';
import { parseMessage, type LiveMessage } from './messages';
import { decodePicture, type Picture } from './picture';

export type ConnectionState = 'connecting' | 'open' | 'lost' | 'closed';

/** The part of WebSocket that is used; tests put their own in its place. */
export interface Socket {
  binaryType: BinaryType;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(data: string): void;
  close(): void;
}

export interface ConnectionOptions {
  /** Gets a ticket and opens a socket with it; rejects if the server refuses or is not there. */
  open: () => Promise<Socket>;
  onMessage: (message: LiveMessage) => void;
  onPicture: (picture: Picture) => void;
  onState: (state: ConnectionState, nextAttemptInMs: number) => void;
  /** A rejection after which trying again makes no sense (no such rig, signed out). */
  isFinal?: (error: unknown) => boolean;
  onFinal?: (error: unknown) => void;
  /** Pictures come at all times: this long without a message and the connection is as good as lost, ms. */
  silence?: number;
}

export class LiveConnection {
  private readonly options: ConnectionOptions;
  private socket: Socket | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private watchdog: ReturnType<typeof setTimeout> | undefined;
  private attempt = 0;
  private closed = false;
  private opening = 0;

  constructor(options: ConnectionOptions) {
    this.options = options;
  }

  start(): void {
    this.options.onState('connecting', 0);
    void this.connect();
  }

  /** Try at once, for instance because the network is said to be back. */
  retryNow(): void {
    if (this.closed || this.socket) return;
    clearTimeout(this.timer);
    void this.connect();
  }

  /** The network is gone: do not wait for the silence to tell. */
  drop(): void {
    if (!this.closed && this.socket) this.lose();
  }

  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    this.release();
    this.options.onState('closed', 0);
  }

  private async connect(): Promise<void> {
    const opening = ++this.opening;
    let socket: Socket;
    try {
      socket = await this.options.open();
    } catch (error) {
      if (this.closed || opening !== this.opening) return;
      if (this.options.isFinal?.(error)) {
        this.close();
        this.options.onFinal?.(error);
      } else {
        this.lose();
      }
      return;
    }
    if (this.closed || opening !== this.opening) {
      socket.close();
      return;
    }
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onmessage = (event) => this.receive(event.data);
    socket.onclose = () => this.lose();
    this.watch();
  }

  private receive(data: unknown): void {
    this.watch();
    if (data instanceof ArrayBuffer) {
      const picture = decodePicture(data);
      if (picture) this.options.onPicture(picture);
      return;
    }
    const message = typeof data === 'string' ? parseMessage(data) : null;
    if (!message) return;
    // Only a hello proves that the ticket was good and the stream is ours.
    if (message.type === 'hello') {
      this.attempt = 0;
      this.options.onState('open', 0);
    }
    this.options.onMessage(message);
    this.socket?.send(JSON.stringify({ ack: message.seq }));
  }

  private watch(): void {
    clearTimeout(this.watchdog);
    this.watchdog = setTimeout(() => this.lose(), this.options.silence ?? 5000);
  }

  private lose(): void {
    this.release();
    clearTimeout(this.timer);
    const delay = backoffDelay(this.attempt);
    this.attempt += 1;
    this.options.onState('lost', delay);
    this.timer = setTimeout(() => void this.connect(), delay);
  }

  private release(): void {
    clearTimeout(this.watchdog);
    this.opening += 1;
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onmessage = null;
    socket.onclose = null;
    socket.close();
  }
}

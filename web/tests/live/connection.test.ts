import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { backoffDelay } from '../../src/live/backoff';
import { LiveConnection, type Socket } from '../../src/live/connection';
import type { LiveMessage } from '../../src/live/messages';

class TestSocket implements Socket {
  binaryType: BinaryType = 'blob';
  onopen = null;
  onmessage: ((event: MessageEvent) => void) | null = null;
  onclose: ((event: CloseEvent) => void) | null = null;
  sent: string[] = [];
  closed = false;
  send(data: string): void {
    this.sent.push(data);
  }
  close(): void {
    this.closed = true;
  }
  say(data: unknown): void {
    this.onmessage?.({ data } as MessageEvent);
  }
}

const hello = JSON.stringify({ type: 'hello', seq: 1, server_time: '2026-11-22T09:00:00Z', rig: { id: 'r', state: 'idle' }, run: null, trail: [] });
const settle = () => vi.advanceTimersByTimeAsync(0);

describe('the live connection', () => {
  let sockets: TestSocket[];
  let states: string[];
  let messages: LiveMessage[];
  let refuse: unknown;
  let connection: LiveConnection;

  beforeEach(() => {
    vi.useFakeTimers();
    sockets = [];
    states = [];
    messages = [];
    refuse = null;
    connection = new LiveConnection({
      open: () => {
        if (refuse) return Promise.reject(refuse);
        const socket = new TestSocket();
        sockets.push(socket);
        return Promise.resolve(socket);
      },
      onMessage: (m) => messages.push(m),
      onPicture: () => {},
      onState: (s) => states.push(s),
      isFinal: (e) => e === 'gone',
      onFinal: () => states.push('final'),
    });
  });

  afterEach(() => {
    connection.close();
    vi.useRealTimers();
  });

  it('is open only after hello, and acknowledges what it handled', async () => {
    connection.start();
    await settle();
    expect(states).toEqual(['connecting']);
    sockets[0]?.say(hello);
    sockets[0]?.say('{"type":"chat","seq":2}');
    sockets[0]?.say('nonsense');
    expect(states).toEqual(['connecting', 'open']);
    expect(sockets[0]?.sent).toEqual(['{"ack":1}', '{"ack":2}']);
    expect(messages).toHaveLength(2);
    expect(sockets[0]?.binaryType).toBe('arraybuffer');
  });

  it('comes back by itself with a new socket each time, waiting longer and longer', async () => {
    connection.start();
    await settle();
    sockets[0]?.say(hello);
    sockets[0]?.onclose?.({} as CloseEvent);
    expect(states.at(-1)).toBe('lost');
    await vi.advanceTimersByTimeAsync(backoffDelay(0, () => 1));
    expect(sockets).toHaveLength(2);
    sockets[1]?.onclose?.({} as CloseEvent);
    await vi.advanceTimersByTimeAsync(backoffDelay(0, () => 1));
    expect(sockets).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(backoffDelay(1, () => 1));
    expect(sockets).toHaveLength(3);
    sockets[2]?.say(hello);
    expect(states.at(-1)).toBe('open');
  });

  it('takes silence for a lost connection', async () => {
    connection.start();
    await settle();
    sockets[0]?.say(hello);
    await vi.advanceTimersByTimeAsync(4999);
    expect(states.at(-1)).toBe('open');
    await vi.advanceTimersByTimeAsync(1);
    expect(states.at(-1)).toBe('lost');
    expect(sockets[0]?.closed).toBe(true);
  });

  it('hears nothing more from a socket that it gave up', async () => {
    connection.start();
    await settle();
    const first = sockets[0];
    connection.drop();
    first?.say(hello);
    expect(messages).toHaveLength(0);
  });

  it('tries at once when asked, and gives up for good when told so', async () => {
    connection.start();
    await settle();
    refuse = 'busy';
    connection.drop();
    refuse = null;
    connection.retryNow();
    await settle();
    expect(sockets).toHaveLength(2);
    refuse = 'gone';
    connection.drop();
    connection.retryNow();
    await settle();
    expect(states.slice(-2)).toEqual(['closed', 'final']);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(sockets).toHaveLength(2);
  });

  it('closes a socket that opens after it was closed', async () => {
    connection.start();
    connection.close();
    await settle();
    expect(sockets[0]?.closed).toBe(true);
    expect(states.at(-1)).toBe('closed');
  });
});

it('waits longer after each attempt, up to eight seconds, a third of it at random', () => {
  expect([0, 1, 2, 3, 4, 5, 50].map((n) => backoffDelay(n, () => 1))).toEqual([500, 1000, 2000, 4000, 8000, 8000, 8000]);
  expect(backoffDelay(4, () => 0)).toBe(5333);
});

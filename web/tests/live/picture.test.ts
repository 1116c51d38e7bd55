import { expect, it } from 'vitest';
import { decodePicture } from '../../src/live/picture';

function message(kind: number, length: number, bytes: number): ArrayBuffer {
  const buffer = new ArrayBuffer(16 + bytes);
  const view = new DataView(buffer);
  view.setUint32(0, kind, true);
  view.setUint32(4, length, true);
  view.setBigUint64(8, 1_795_338_000_123_456_789n, true);
  new Uint8Array(buffer, 16).fill(7);
  return buffer;
}

it('takes the JPEG and its time out of the message', () => {
  const picture = decodePicture(message(1, 3, 3));
  expect(picture?.t).toBeCloseTo(1_795_338_000_123.456, 2);
  expect([...(picture?.jpeg ?? [])]).toEqual([7, 7, 7]);
});

it('refuses another kind, nothing at all, and what was cut short', () => {
  expect(decodePicture(message(2, 3, 3))).toBeNull();
  expect(decodePicture(message(1, 0, 0))).toBeNull();
  expect(decodePicture(message(1, 4, 3))).toBeNull();
  expect(decodePicture(new ArrayBuffer(15))).toBeNull();
});

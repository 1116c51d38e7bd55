/** Binary messages: u32 kind = 1, u32 bytes of JPEG, u64 capture time in ns, the JPEG; little-endian. */

export interface Picture {
  /** Capture, ms since the epoch. */
  t: number;
  jpeg: Uint8Array<ArrayBuffer>;
}

const header = 16;

/** null for another kind of message, or one that was cut short. */
export function decodePicture(message: ArrayBuffer): Picture | null {
  if (message.byteLength < header) return null;
  const view = new DataView(message);
  if (view.getUint32(0, true) !== 1) return null;
  const length = view.getUint32(4, true);
  if (length === 0 || header + length > message.byteLength) return null;
  return { t: Number(view.getBigUint64(8, true) / 1000n) / 1000, jpeg: new Uint8Array(message, header, length) };
}

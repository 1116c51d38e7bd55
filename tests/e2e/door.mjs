// One address for a server that is restarted on another port: bytes pass through, nothing is changed.
import { connect, createServer } from 'node:net';

export async function openDoor(port) {
  const open = new Set();
  const door = { port };
  const listener = createServer((outside) => {
    const inside = connect(door.port, '127.0.0.1');
    for (const [socket, other] of [[outside, inside], [inside, outside]]) {
      open.add(socket);
      socket.pipe(other);
      socket.on('error', () => other.destroy());
      socket.on('close', () => {
        open.delete(socket);
        other.destroy();
      });
    }
  });
  await new Promise((resolve) => listener.listen(0, '127.0.0.1', resolve));
  door.url = `http://127.0.0.1:${listener.address().port}`;
  door.close = () => {
    listener.close();
    for (const socket of open) socket.destroy();
  };
  return door;
}

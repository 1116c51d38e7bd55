/** The rig as a 3-D scene in the lab frame. Draws only when something changed. Only the files of this folder
 * know three.js; they are loaded when the scene is first shown. */
import { AmbientLight, DirectionalLight, GridHelper, Line, Mesh, PerspectiveCamera, Points, Scene, WebGLRenderer } from 'three';
import type { Body } from '../models/bodies';
import { color, objectColor } from '../plots/theme';
import { viewpoint, type Framing } from './geometry';
import { MovingBody } from './moving_body';
import { Stand } from './stand';

type Vec3 = readonly [number, number, number];

export class RigScene {
  azimuth = -0.5;
  elevation = 0.22;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(38, 4 / 3, 0.05, 60);
  private readonly stand = new Stand();
  private readonly bodies = new Map<string, MovingBody>();
  private grid: GridHelper | null = null;
  private framing: Framing = { target: [0, 0, 0], distance: 2.4, floor: -0.5, half: 0.9 };
  private dirty = true;

  /** Throws if the browser has no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    const lamp = new DirectionalLight(0xffffff, 2.2);
    lamp.position.set(-1.5, -2, 3);
    this.stand.group.visible = false;
    this.scene.add(new AmbientLight(0xffffff, 1.1), lamp, this.stand.group);
    this.lay();
  }

  setTheme(): void {
    this.stand.setTheme();
    for (const body of this.bodies.values()) body.setTheme();
    this.lay();
  }

  /** What can be seen, in the order that gives it its colours. */
  setBodies(bodies: readonly Body[]): void {
    for (const body of this.bodies.values()) {
      this.scene.remove(...body.parts);
      body.parts.forEach(disposeOf);
    }
    this.bodies.clear();
    bodies.forEach((body, i) => {
      const moving = new MovingBody(body, objectColor(i));
      moving.setFloor(this.framing.floor);
      this.bodies.set(body.name, moving);
      this.scene.add(...moving.parts);
    });
    this.dirty = true;
  }

  setPose(name: string, p: Vec3, q: readonly [number, number, number, number] | null): void {
    this.bodies.get(name)?.setPose(p, q);
    this.dirty = true;
  }

  setTrail(name: string, x: Float64Array, y: Float64Array, z: Float64Array): void {
    this.bodies.get(name)?.setTrail(x, y, z);
    this.dirty = true;
  }

  hide(name: string): void {
    this.bodies.get(name)?.hide();
    this.dirty = true;
  }

  /** How far around a body's centre it reaches, m. */
  reach(name: string): number {
    return this.bodies.get(name)?.radius ?? 0.05;
  }

  /** `pivot`: height at which a pendulum hangs; null where nothing hangs. */
  setFraming(framing: Framing, pivot: number | null): void {
    this.framing = framing;
    this.stand.group.visible = pivot !== null;
    if (pivot !== null) this.stand.build(pivot, framing.floor, framing.half - 0.2);
    for (const body of this.bodies.values()) body.setFloor(framing.floor);
    this.lay();
  }

  hang(p: Vec3): void {
    this.stand.holdAt(p);
    this.dirty = true;
  }

  turn(azimuth: number, elevation: number): void {
    this.azimuth = azimuth;
    this.elevation = Math.min(1.5, Math.max(0.02, elevation));
    this.dirty = true;
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    const ratio = this.renderer.getPixelRatio();
    if (this.canvas.width !== Math.floor(width * ratio) || this.canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.dirty = true;
    }
    if (!this.dirty) return;
    this.dirty = false;
    const { target, distance } = this.framing;
    this.camera.position.set(...viewpoint(target, this.azimuth, this.elevation, distance));
    this.camera.lookAt(...target);
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    disposeOf(this.scene);
    this.renderer.dispose();
  }

  /** A floor of 10 cm squares. */
  private lay(): void {
    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.dispose();
    }
    const size = Math.ceil(2 * this.framing.half) + 0.4;
    this.grid = new GridHelper(size, Math.round(size * 10), color('--line-strong'), color('--line'));
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.set(this.framing.target[0], this.framing.target[1], this.framing.floor);
    this.scene.add(this.grid);
    this.dirty = true;
  }
}

function disposeOf(root: { traverse: Scene['traverse'] }): void {
  root.traverse((object) => {
    if (!(object instanceof Mesh || object instanceof Line || object instanceof Points)) return;
    object.geometry.dispose();
    for (const material of [object.material].flat()) material.dispose();
  });
}

/** One thing that is watched: its shape, its shade on the floor, the path behind it. */
import {
  AxesHelper, BoxGeometry, BufferAttribute, BufferGeometry, CircleGeometry, Color, ConeGeometry, CylinderGeometry, Group, Line, LineBasicMaterial, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, Points, PointsMaterial, SphereGeometry, type Object3D,
} from 'three';
import type { Body } from '../models/bodies';
import { color } from '../plots/theme';

const trailPoints = 300;

export class MovingBody {
  readonly parts: Object3D[];
  readonly radius: number;
  private readonly group = new Group();
  private readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly axes = new AxesHelper(1);
  private readonly shade = new Mesh(new CircleGeometry(1, 32), new MeshBasicMaterial({ transparent: true, opacity: 0.22, depthWrite: false }));
  private readonly trail = new Line(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true, transparent: true }));
  /** A dot for each measured pose, on the same buffers as the line through them. */
  private readonly dots = new Points(this.trail.geometry, new PointsMaterial({ size: 0.014, vertexColors: true, transparent: true, depthWrite: false }));

  constructor(readonly body: Body, private readonly colorName: string) {
    this.mesh = new Mesh(geometryOf(body), new MeshStandardMaterial({ roughness: 0.45 }));
    this.radius = reachOf(body);
    this.axes.scale.setScalar(1.8 * this.radius);
    this.axes.visible = false;
    this.group.add(this.mesh, this.axes);
    this.shade.scale.setScalar(this.radius * 1.1);
    const geometry = this.trail.geometry;
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * trailPoints), 3));
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(4 * trailPoints), 4));
    geometry.setDrawRange(0, 0);
    this.trail.frustumCulled = this.dots.frustumCulled = false;
    this.group.visible = this.shade.visible = false;
    this.parts = [this.group, this.shade, this.trail, this.dots];
    this.setTheme();
  }

  setTheme(): void {
    this.mesh.material.color.set(color(this.colorName));
    this.shade.material.color.set(color('--text'));
    const rgb = new Color(color(this.colorName));
    const colors = this.trail.geometry.getAttribute('color');
    for (let i = 0; i < trailPoints; i++) colors.setXYZW(i, rgb.r, rgb.g, rgb.b, 1);
    colors.needsUpdate = true;
  }

  /** `q` is x, y, z, w; null where the body is followed without its orientation. */
  setPose(p: readonly [number, number, number], q: readonly [number, number, number, number] | null): void {
    this.group.visible = this.shade.visible = true;
    this.group.position.set(...p);
    this.shade.position.setX(p[0]);
    this.shade.position.setY(p[1]);
    this.axes.visible = q !== null;
    if (q) this.group.quaternion.set(...q);
  }

  hide(): void {
    this.group.visible = this.shade.visible = false;
    this.trail.geometry.setDrawRange(0, 0);
  }

  setFloor(floor: number): void {
    this.shade.position.setZ(floor + 0.002);
  }

  /** The newest points of the path, oldest first; unseen ones are left out. */
  setTrail(x: Float64Array, y: Float64Array, z: Float64Array): void {
    const positions = this.trail.geometry.getAttribute('position');
    const colors = this.trail.geometry.getAttribute('color');
    const from = Math.max(0, x.length - trailPoints);
    let n = 0;
    for (let i = from; i < x.length; i++) {
      if (!Number.isFinite(x[i])) continue;
      positions.setXYZ(n, x[i] ?? 0, y[i] ?? 0, z[i] ?? 0);
      colors.setW(n, ((i - from) / (x.length - from)) ** 1.5);
      n += 1;
    }
    positions.needsUpdate = true;
    colors.needsUpdate = true;
    this.trail.geometry.setDrawRange(0, n);
  }
}

function geometryOf(body: Body): BufferGeometry {
  switch (body.shape) {
    case 'sphere':
      return new SphereGeometry(body.radius, 40, 24);
    // Their axes are z in the lab, y in three.js.
    case 'cylinder':
      return new CylinderGeometry(body.radius, body.radius, body.length, 32).rotateX(Math.PI / 2);
    case 'cone':
      return new ConeGeometry(body.radius, body.length, 32).rotateX(Math.PI / 2);
    case 'box':
      return new BoxGeometry(...body.size);
  }
}

function reachOf(body: Body): number {
  switch (body.shape) {
    case 'box':
      return Math.hypot(...body.size) / 2;
    case 'sphere':
      return body.radius;
    default:
      return Math.max(body.radius, body.length / 2);
  }
}

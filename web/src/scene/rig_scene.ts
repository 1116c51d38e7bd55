/** The rig as a 3-D scene: frame, string, bob and trail in the lab frame. Draws only when something
 * changed. The only file that knows three.js; loaded when the scene is first shown. */
import {
  AmbientLight, BufferAttribute, BufferGeometry, CircleGeometry, Color, CylinderGeometry, DirectionalLight, GridHelper, Line,
  LineBasicMaterial, Mesh, MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, Points, PointsMaterial, Scene, SphereGeometry, Vector3, WebGLRenderer,
} from 'three';
import { color } from '../plots/theme';
import { viewpoint } from './geometry';

export interface RigShape {
  length: number;
  bobRadius: number;
  /** m, lab frame */
  pivot: number;
}

const trailPoints = 300;

export class RigScene {
  azimuth = -0.5;
  elevation = 0.22;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(38, 4 / 3, 0.05, 30);
  private readonly bob = new Mesh(new SphereGeometry(1, 40, 24), new MeshStandardMaterial({ roughness: 0.45 }));
  private readonly string = new Mesh(new CylinderGeometry(0.003, 0.003, 1, 6), new MeshBasicMaterial());
  private readonly shade = new Mesh(new CircleGeometry(1, 32), new MeshBasicMaterial({ transparent: true, opacity: 0.22, depthWrite: false }));
  private readonly trail = new Line(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true, transparent: true }));
  /** A dot for each measured pose, on the same buffers as the line through them. */
  private readonly dots = new Points(this.trail.geometry, new PointsMaterial({ size: 0.014, vertexColors: true, transparent: true, depthWrite: false }));
  private readonly frameMaterial = new MeshStandardMaterial({ roughness: 0.8 });
  private frame: Mesh[] = [];
  private grid: GridHelper | null = null;
  private shape: RigShape | null = null;
  private dirty = true;

  /** Throws if the browser has no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    const lamp = new DirectionalLight(0xffffff, 2.2);
    lamp.position.set(-1.5, -2, 3);
    this.scene.add(new AmbientLight(0xffffff, 1.1), lamp, this.bob, this.string, this.shade, this.trail, this.dots);
    const geometry = this.trail.geometry;
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * trailPoints), 3));
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(4 * trailPoints), 4));
    geometry.setDrawRange(0, 0);
    this.trail.frustumCulled = this.dots.frustumCulled = false;
    this.bob.visible = this.string.visible = this.shade.visible = false;
    this.setTheme();
  }

  setTheme(): void {
    this.bob.material.color.set(color('--bob'));
    this.string.material.color.set(color('--text-soft'));
    this.shade.material.color.set(color('--text'));
    this.frameMaterial.color.set(color('--line-strong'));
    const rgb = new Color(color('--plot-x'));
    const colors = this.trail.geometry.getAttribute('color');
    for (let i = 0; i < trailPoints; i++) colors.setXYZW(i, rgb.r, rgb.g, rgb.b, 1);
    colors.needsUpdate = true;
    if (this.shape) this.build(this.shape);
    this.dirty = true;
  }

  setShape(shape: RigShape): void {
    const s = this.shape;
    if (s && s.length === shape.length && s.bobRadius === shape.bobRadius && Math.abs(s.pivot - shape.pivot) < 0.01) return;
    this.build(shape);
  }

  /** The bob's centre, m. */
  setBob(x: number, y: number, z: number): void {
    if (!this.shape) return;
    this.bob.visible = this.string.visible = this.shade.visible = true;
    this.dirty = true;
    this.bob.position.set(x, y, z);
    this.shade.position.set(x, y, this.floor() + 0.002);
    const pivot = new Vector3(0, 0, this.shape.pivot);
    const along = pivot.clone().sub(this.bob.position);
    this.string.position.copy(this.bob.position).addScaledVector(along, 0.5);
    this.string.scale.set(1, along.length(), 1);
    this.string.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
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
    const shape = this.shape ?? { length: 1, pivot: 0, bobRadius: 0.05 };
    const target: [number, number, number] = [0, 0, shape.pivot - 0.55 * shape.length];
    this.camera.position.set(...viewpoint(target, this.azimuth, this.elevation, 0.9 + 1.5 * shape.length));
    this.camera.lookAt(...target);
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.scene.traverse((object) => {
      if (!(object instanceof Mesh || object instanceof Line || object instanceof Points)) return;
      object.geometry.dispose();
      for (const material of [object.material].flat()) material.dispose();
    });
    this.renderer.dispose();
  }

  private floor(): number {
    return this.shape ? this.shape.pivot - this.shape.length - this.shape.bobRadius - 0.12 : 0;
  }

  /** Two posts, a beam, and a floor of 10 cm squares. */
  private build(shape: RigShape): void {
    this.shape = shape;
    for (const part of this.frame) {
      part.geometry.dispose();
      this.scene.remove(part);
    }
    const floor = this.floor();
    const height = shape.pivot - floor;
    const half = 0.2 + 0.45 * shape.length;
    const post = (x: number) => {
      const mesh = new Mesh(new CylinderGeometry(0.014, 0.014, height, 12), this.frameMaterial);
      mesh.position.set(x, 0, floor + height / 2);
      mesh.rotation.x = Math.PI / 2;
      return mesh;
    };
    const beam = new Mesh(new CylinderGeometry(0.017, 0.017, 2 * half + 0.06, 12), this.frameMaterial);
    beam.position.set(0, 0, shape.pivot);
    beam.rotation.z = Math.PI / 2;
    this.frame = [post(-half), post(half), beam];
    this.scene.add(...this.frame);

    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.dispose();
    }
    const size = Math.ceil(2 * half + 0.4) + 0.4;
    this.grid = new GridHelper(size, Math.round(size * 10), color('--line-strong'), color('--line'));
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.z = floor;
    this.scene.add(this.grid);
    this.bob.scale.setScalar(shape.bobRadius);
    this.shade.scale.setScalar(shape.bobRadius * 1.1);
    this.dirty = true;
  }
}

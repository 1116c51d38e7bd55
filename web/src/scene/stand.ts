/** What a pendulum hangs on: two posts, a beam, the string. */
import { CylinderGeometry, Group, Mesh, MeshBasicMaterial, MeshStandardMaterial, Vector3 } from 'three';
import { color } from '../plots/theme';

export class Stand {
  readonly group = new Group();
  private readonly string = new Mesh(new CylinderGeometry(0.003, 0.003, 1, 6), new MeshBasicMaterial());
  private readonly material = new MeshStandardMaterial({ roughness: 0.8 });
  private bars: Mesh[] = [];
  private pivot = new Vector3();

  constructor() {
    this.string.visible = false;
    this.group.add(this.string);
    this.setTheme();
  }

  setTheme(): void {
    this.string.material.color.set(color('--text-soft'));
    this.material.color.set(color('--line-strong'));
  }

  build(pivot: number, floor: number, half: number): void {
    for (const bar of this.bars) bar.geometry.dispose();
    this.group.remove(...this.bars);
    this.pivot = new Vector3(0, 0, pivot);
    const height = pivot - floor;
    const post = (x: number) => {
      const mesh = new Mesh(new CylinderGeometry(0.014, 0.014, height, 12), this.material);
      mesh.position.set(x, 0, floor + height / 2);
      mesh.rotation.x = Math.PI / 2;
      return mesh;
    };
    const beam = new Mesh(new CylinderGeometry(0.017, 0.017, 2 * half + 0.06, 12), this.material);
    beam.position.set(0, 0, pivot);
    beam.rotation.z = Math.PI / 2;
    this.bars = [post(-half), post(half), beam];
    this.group.add(...this.bars);
  }

  holdAt(p: readonly [number, number, number]): void {
    const bob = new Vector3(...p);
    const along = this.pivot.clone().sub(bob);
    this.string.visible = true;
    this.string.position.copy(bob).addScaledVector(along, 0.5);
    this.string.scale.set(1, along.length(), 1);
    this.string.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
  }
}

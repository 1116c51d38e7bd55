/** The newest `capacity` rows of several columns, each column always one piece of memory: plots take
 * it as it is. Pushing costs a move of the whole only once in `capacity` rows. */
export class SlidingColumns {
  readonly capacity: number;
  private readonly columns: Float64Array[];
  private begin = 0;
  private end = 0;

  constructor(width: number, capacity: number) {
    this.capacity = capacity;
    this.columns = Array.from({ length: width }, () => new Float64Array(2 * capacity));
  }

  get length(): number {
    return this.end - this.begin;
  }

  push(...row: number[]): void {
    if (this.end === 2 * this.capacity) this.moveToFront();
    this.columns.forEach((column, i) => (column[this.end] = row[i] ?? NaN));
    this.end += 1;
    if (this.length > this.capacity) this.begin += 1;
  }

  clear(): void {
    this.begin = 0;
    this.end = 0;
  }

  /** A view, not a copy: valid until the next push. */
  column(i: number, from = 0): Float64Array {
    const column = this.columns[i];
    if (!column) throw new RangeError(`column ${i} of ${this.columns.length}`);
    return column.subarray(this.begin + from, this.end);
  }

  last(i: number): number {
    return this.length === 0 ? NaN : (this.columns[i]?.[this.end - 1] ?? NaN);
  }

  /** The first row whose value in an increasing column is at least `value`. */
  lowerBound(i: number, value: number): number {
    const column = this.column(i);
    let low = 0;
    let high = column.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((column[middle] ?? 0) < value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  private moveToFront(): void {
    for (const column of this.columns) column.copyWithin(0, this.begin, this.end);
    this.end -= this.begin;
    this.begin = 0;
  }
}

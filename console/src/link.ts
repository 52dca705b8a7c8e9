// SPDX-License-Identifier: Apache-2.0
// What the map, the plots and the tables tell each other.

export interface Selection {
  sample: number|null;          // index of the sample under the pointer
  range: [number, number]|null; // driven distance shown in the plots [m]; null: all
  leg: number|null;             // leg picked in a table
}

export class Link {
  private state: Selection = {sample: null, range: null, leg: null};
  private listeners: ((state: Selection, what: keyof Selection) => void)[] = [];

  get current(): Readonly<Selection> {
    return this.state;
  }
  listen(listener: (state: Selection, what: keyof Selection) => void): void {
    this.listeners.push(listener);
  }
  set<K extends keyof Selection>(what: K, value: Selection[K]): void {
    if (this.state[what] === value) return;
    this.state[what] = value;
    for (const listener of this.listeners) listener(this.state, what);
  }
}

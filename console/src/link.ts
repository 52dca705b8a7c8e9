// SPDX-License-Identifier: Apache-2.0
// What the map, the plots, the tables and the player tell each other.
import {duration} from './motion';
import {Scene} from './types';

export interface Cursor {
  s: number;            // driven distance [m]
  vehicle: number|null; // null: all of them
}

export interface LegOf {
  vehicle: number;
  leg: number;
}

export interface Selection {
  cursor: Cursor|null;          // under the pointer
  range: [number, number]|null; // driven distance shown in the plots [m]; null: all
  leg: LegOf|null;              // picked in a table
  time: number|null;            // that the map shows [s]; null: nothing moves
  follow: boolean;              // whether the map keeps the vehicle in its middle
}

export class Link {
  private state: Selection;
  private listeners: ((state: Selection, what: keyof Selection) => void)[] = [];

  /// At the scene's beginning; a single vehicle among agents is followed.
  constructor(scene: Scene) {
    const time = duration(scene)?.[0] ?? null;
    this.state = {cursor: null, range: null, leg: null, time, follow: time !== null && scene.agents !== undefined && scene.vehicles.length === 1};
  }

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
  /// Picks a leg, or lets it go if it is picked.
  toggle_leg(leg: LegOf): void {
    const now = this.state.leg;
    this.set('leg', now && now.vehicle === leg.vehicle && now.leg === leg.leg ? null : leg);
  }
}

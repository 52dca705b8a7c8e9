// SPDX-License-Identifier: Apache-2.0
// Plays a scene: moves the time that map and plots show.
import {element} from './dom';
import {clock, fixed} from './format';
import {layer_of} from './layers';
import {Link} from './link';
import {duration, motion_at} from './motion';
import {Feature, Scene} from './types';

const kRates = [0.5, 1, 2, 5, 10, 30, 100, 300];
const kPatience = 60; // s that a scene may take at first
const kLeadIn = 3;    // s before an event that is jumped to

/// The slowest rate at which so many seconds are over in time.
export function first_rate(seconds: number): number {
  return kRates.find((rate) => rate >= 1 && seconds / rate <= kPatience) ?? kRates[kRates.length - 1]!;
}

/// The events of a scene, in order.
export function events_of(scene: Scene): Feature[] {
  return scene.map.features.filter((f) => f.t_s !== undefined).sort((a, b) => a.t_s! - b.t_s!);
}

export class Player {
  readonly root: HTMLElement;
  private readonly first: number;
  private readonly last: number;
  private readonly events: Feature[];
  private readonly button: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly text = element('output', {class: 'player-text'});
  private rate: number;
  private shown_at: number|null = null; // the browser's clock at the last frame [ms]; null: it stands

  constructor(private readonly scene: Scene, private readonly link: Link) {
    [this.first, this.last] = duration(scene)!;
    this.events = events_of(scene);
    this.rate = first_rate(this.last - this.first);
    this.button = element('button', {type: 'button', class: 'quiet player-play', click: () => this.toggle()});
    this.slider = element('input', {
      type: 'range', min: String(this.first), max: String(this.last), step: 'any', 'aria-label': 'Time',
      input: () => this.go_to(Number(this.slider.value)),
    });
    this.root = element('div', {class: 'player', role: 'group', 'aria-label': 'Play'}, this.button, ...this.jumps(),
                        element('div', {class: 'player-track'}, this.slider, ...this.events.map((e) => this.tick(e))),
                        this.rates(), ...this.follow(), this.text);
    this.show_state();
    link.listen((_, what) => what === 'time' && this.show_time());
    this.show_time();
  }

  private jumps(): HTMLElement[] {
    if (this.events.length === 0) return [];
    const jump = (label: string, text: string, find: (t: number) => Feature|undefined) => element(
        'button', {type: 'button', class: 'quiet', title: label, 'aria-label': label, click: () => {
          const event = find(this.link.current.time! + kLeadIn);
          if (event) this.go_to(event.t_s! - kLeadIn);
        }}, text);
    return [jump('Event before', '|\u25c0', (t) => [...this.events].reverse().find((e) => e.t_s! < t - 0.05)),
            jump('Next event', '\u25b6|', (t) => this.events.find((e) => e.t_s! > t + 0.05))];
  }

  private tick(event: Feature): HTMLElement {
    const node = element('i', {title: `${clock(event.t_s!)} ${event.name ?? ''}`});
    node.style.left = `${100 * (event.t_s! - this.first) / Math.max(this.last - this.first, 1e-9)}%`;
    node.style.background = `var(--${layer_of(event.kind).stroke ?? 'muted'})`;
    return node;
  }

  private rates(): HTMLElement {
    const select = element('select', {'aria-label': 'Speed'},
        ...kRates.map((rate) => element('option', {value: String(rate), selected: rate === this.rate}, `${rate}\u00d7`)));
    select.addEventListener('change', () => this.rate = Number(select.value));
    return select;
  }

  private follow(): HTMLElement[] {
    if (this.scene.vehicles.length > 1) return [];
    const box = element('input', {type: 'checkbox', checked: this.link.current.follow});
    box.addEventListener('change', () => this.link.set('follow', box.checked));
    this.link.listen((state, what) => {
      if (what === 'follow') box.checked = state.follow;
    });
    return [element('label', {}, box, 'Follow')];
  }

  private go_to(t: number): void {
    this.link.set('time', Math.min(this.last, Math.max(this.first, t)));
  }

  private toggle(): void {
    if (this.shown_at !== null) return this.stop();
    if (this.link.current.time! >= this.last) this.go_to(this.first);
    this.shown_at = performance.now();
    this.show_state();
    requestAnimationFrame((now) => this.frame(now));
  }
  private stop(): void {
    this.shown_at = null;
    this.show_state();
  }

  private frame(now: number): void {
    if (this.shown_at === null) return;
    if (!this.root.isConnected) return this.stop(); // another scene is shown
    this.go_to(this.link.current.time! + this.rate * Math.max(0, now - this.shown_at) / 1000);
    this.shown_at = now;
    if (this.link.current.time! >= this.last) return this.stop();
    requestAnimationFrame((next) => this.frame(next));
  }

  private show_state(): void {
    const playing = this.shown_at !== null;
    this.button.textContent = playing ? '\u275a\u275a' : '\u25b6';
    this.button.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    this.button.title = playing ? 'Pause' : 'Play';
  }

  private show_time(): void {
    const t = this.link.current.time!;
    this.slider.value = String(t);
    const parts = [`${clock(t)} / ${clock(this.last)}`];
    if (this.scene.vehicles.length === 1) parts.push(...this.about_vehicle(t));
    const event = [...this.events].reverse().find((e) => e.t_s! <= t + 0.05 && e.t_s! > t - 2);
    if (event) parts.push(event.name || event.kind);
    this.text.textContent = parts.join('   ');
  }

  private about_vehicle(t: number): string[] {
    const {series} = this.scene.vehicles[0]!;
    const i = motion_at(series, t).sample;
    const goal = this.scene.map.features.find((f) => f.kind === 'goal' && f.leg === series.leg[i]);
    return [...(series.speed_mps.length ? [`${fixed(series.speed_mps[i], 1)} m/s`] : []),
            ...(series.clearance_m.length ? [`clearance ${fixed(series.clearance_m[i], 1)} m`] : []),
            ...(goal ? [`to ${goal.name}`] : [])];
  }
}

// SPDX-License-Identifier: Apache-2.0
// The map: a canvas with pan and zoom, a legend that toggles layers, and a marker shared with the
// plots.
import {select} from 'd3-selection';
import {ZoomTransform, zoom, zoomIdentity, zoomTransform} from 'd3-zoom';
import {bisectLeft} from 'd3-array';

import {Theme, ramp, series_color} from './color';
import {begin_drawing, element, once_per_frame} from './dom';
import {add_driven, empty_bins, error_scale, kBins} from './driven';
import {fixed, number} from './format';
import {Layer, LayerSet, lines_of} from './layers';
import {legend} from './legend';
import {LegOf, Link} from './link';
import {ColorBar, Labels, coordinates_text, make_path, paint_color_bars, paint_dot, paint_direction, paint_layer, paint_mark,
        paint_scale_bar} from './map_paint';
import {duration, motion_at, plays} from './motion';
import {Moving} from './moving';
import {Player} from './player';
import {nearest} from './plot';
import {sample_rows} from './sample';
import {Relief, tint_text} from './terrain';
import {Feature, Position, Scene, Terrain, Vehicle} from './types';
import {Bounds, View, empty_bounds, extend, nearest_sample} from './view';

const kMaxZoom = 400;
const kFillOnRelief = 0.45; // opacity of areas above the relief
const kBandWidth = 0.6; // m; of a plan below a driven path
const kFleetBand = 6;  // px; the same where there are several vehicles
const kFollowed = 30;  // m around a followed vehicle
const kEventShown = 1; // s before and after it is marked
const kGrab = 28; // px within which the pointer catches the nearest sample

export class MapView {
  readonly root: HTMLElement;
  private readonly ground = element('canvas', {'aria-hidden': 'true'});
  private readonly overlay = element('canvas', {
    class: 'grab', tabindex: '0', role: 'application',
    'aria-label': 'Map. Arrow keys move it, plus and minus zoom, 0 shows all.',
  });
  private readonly tip = element('div', {class: 'tip', hidden: true});
  private readonly readout = element('output', {class: 'readout', 'aria-label': 'Coordinates'});
  private readonly features: Feature[];
  private readonly vehicles: Vehicle[];
  private readonly terrain: Terrain|undefined;
  private readonly relief: Relief|null;
  private readonly moving: Moving;
  private readonly set: LayerSet;
  private readonly layers: Layer[];
  private readonly hidden = new Set<Layer>();
  private readonly paths = new Map<Layer, Path2D>();
  private readonly bounds: Bounds = empty_bounds();
  private readonly origin: Position;
  private readonly full_scale_m: number;
  private readonly has_driven: boolean;
  private driven: Path2D[] = [];
  private focus: Path2D[]|null = null; // the part of the driven path that the plots show
  private view: View;
  private readonly zoom = zoom<HTMLCanvasElement>().scaleExtent([0.5, kMaxZoom]);
  private readonly draw = once_per_frame(() => this.paint());
  private readonly draw_overlay = once_per_frame(() => this.paint_overlay());

  constructor(private readonly scene: Scene, private readonly link: Link, private readonly theme: () => Theme) {
    const features = this.features = scene.map.features;
    this.vehicles = scene.vehicles;
    this.terrain = scene.terrain;
    this.relief = scene.terrain ? new Relief(scene.terrain) : null;
    this.moving = new Moving(scene);
    this.has_driven = this.vehicles.some(({series}) => series.x_m.length > 1 && series.error_m.length > 0);
    this.set = new LayerSet(this.vehicles);
    this.layers = this.set.used(features, this.has_driven, this.terrain);
    for (const f of features) for (const line of lines_of(f)) for (const [x, y] of line) extend(this.bounds, x, y);
    for (const {series} of this.vehicles) series.x_m.forEach((x, i) => extend(this.bounds, x, series.y_m[i]!));
    this.origin = [(this.bounds.min_x + this.bounds.max_x) / 2, (this.bounds.min_y + this.bounds.max_y) / 2];
    for (const layer of this.layers) {
      this.paths.set(layer, layer.key === 'contours' ? this.relief!.contours(this.origin) :
          make_path(features.filter((f) => this.set.of(f) === layer), this.origin));
    }
    this.full_scale_m = error_scale(this.vehicles.flatMap(({series}) => series.error_m));
    if (this.has_driven) this.driven = this.driven_between(-Infinity, Infinity);
    this.view = new View(this.bounds, 1, 1);
    this.root = this.build();
    this.connect();
  }

  repaint(): void {
    this.draw();
    this.draw_overlay();
  }
  repaint_now(): void {
    this.paint();
  }

  private build(): HTMLElement {
    const button = (label: string, text: string, action: () => void) =>
        element('button', {type: 'button', 'aria-label': label, title: label, click: action}, text);
    const on_canvas = () => select(this.overlay);
    const controls = element('div', {class: 'map-controls'},
        button('Zoom in', '+', () => this.zoom.scaleBy(on_canvas(), 1.6)),
        button('Zoom out', '\u2212', () => this.zoom.scaleBy(on_canvas(), 1 / 1.6)),
        button('Show all', '\u2922', () => this.fit()));
    return element('section', {class: 'card map-card', 'aria-label': 'Map'},
        element('div', {class: 'map-frame'}, this.ground, this.overlay, controls, this.readout, this.tip),
        ...(duration(this.scene) ? [new Player(this.scene, this.link).root] : []),
        legend(this.layers, this.relief ? {contours: `Contours, every ${number(this.relief.interval_m)} m`} : {}, (layer, shown) => {
          if (shown) this.hidden.delete(layer);
          else this.hidden.add(layer);
          this.draw();
        }));
  }

  private connect(): void {
    this.zoom.on('zoom', () => this.repaint());
    select(this.overlay).call(this.zoom).on('dblclick.zoom', null);
    this.overlay.addEventListener('dblclick', () => this.fit());
    this.overlay.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0) this.link.set('follow', false);
      this.hover(event.offsetX, event.offsetY);
    });
    this.overlay.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
      this.readout.textContent = '';
      this.link.set('cursor', null);
    });
    this.overlay.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => {
      this.view = new View(this.bounds, this.overlay.clientWidth, this.overlay.clientHeight);
      this.follow(true);
      this.repaint();
    }).observe(this.overlay);
    this.link.listen((state, what) => {
      if (what === 'cursor' || what === 'time') this.draw_overlay();
      if (what === 'cursor') return;
      if (what === 'time' || what === 'follow') this.follow(what === 'follow');
      if (what === 'range') this.show_range(state.range);
      if (what === 'leg' && state.leg !== null) this.fit(this.leg_bounds(state.leg));
      if (what === 'leg') this.repaint();
    });
  }

  private key(event: KeyboardEvent): void {
    const canvas = select(this.overlay);
    const step = 60 / this.transform().k;
    const actions: Record<string, () => void> = {
      '+': () => this.zoom.scaleBy(canvas, 1.4),
      '=': () => this.zoom.scaleBy(canvas, 1.4),
      '-': () => this.zoom.scaleBy(canvas, 1 / 1.4),
      '0': () => this.fit(),
      ArrowLeft: () => this.zoom.translateBy(canvas, step, 0),
      ArrowRight: () => this.zoom.translateBy(canvas, -step, 0),
      ArrowUp: () => this.zoom.translateBy(canvas, 0, step),
      ArrowDown: () => this.zoom.translateBy(canvas, 0, -step),
    };
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  }

  private transform(): ZoomTransform {
    return zoomTransform(this.overlay);
  }
  private scale(): number {
    return this.view.scale * this.transform().k;
  }
  private to_screen(x: number, y: number): Position {
    const t = this.transform();
    const [px, py] = this.view.to_screen(x, y);
    return [t.x + t.k * px, t.y + t.k * py];
  }

  /// Brings the vehicle into the middle, if it is followed; `nearer`: and its surroundings up.
  private follow(nearer: boolean): void {
    const {time, follow} = this.link.current;
    const series = this.vehicles[0]?.series;
    if (!follow || time === null || !series || !plays(series)) return;
    const {clientWidth: width, clientHeight: height} = this.overlay;
    const close = nearer ? Math.min(width, height) / (kFollowed * this.view.scale) : 0;
    const k = Math.min(kMaxZoom, Math.max(this.transform().k, close));
    const {x, y} = motion_at(series, time);
    const [px, py] = this.view.to_screen(x, y);
    this.zoom.transform(select(this.overlay), zoomIdentity.translate(width / 2 - k * px, height / 2 - k * py).scale(k));
  }

  /// Shows the bounds given, or all.
  private fit(bounds: Bounds|null = null): void {
    this.link.set('follow', false);
    let target = zoomIdentity;
    if (bounds && bounds.max_x >= bounds.min_x) {
      const {clientWidth: width, clientHeight: height} = this.overlay;
      const wanted = new View(bounds, width, height, 60);
      const k = Math.min(wanted.scale / this.view.scale, 40);
      const [px, py] = this.view.to_screen((bounds.min_x + bounds.max_x) / 2, (bounds.min_y + bounds.max_y) / 2);
      target = zoomIdentity.translate(width / 2 - k * px, height / 2 - k * py).scale(k);
    }
    this.zoom.transform(select(this.overlay), target);
  }

  private leg_bounds(leg: LegOf): Bounds {
    const bounds = empty_bounds();
    for (const f of this.leg_features(leg)) for (const line of lines_of(f)) for (const [x, y] of line) extend(bounds, x, y);
    const series = this.vehicles[leg.vehicle]?.series;
    series?.leg.forEach((l, i) => l === leg.leg && extend(bounds, series.x_m[i]!, series.y_m[i]!));
    return bounds;
  }
  private leg_features(leg: LegOf): Feature[] {
    return this.features.filter((f) => f.leg === leg.leg && (f.vehicle ?? 0) === leg.vehicle);
  }

  private driven_between(from_s: number, to_s: number): Path2D[] {
    const bins = empty_bins();
    for (const {series} of this.vehicles) {
      const first = Math.max(0, bisectLeft(series.s_m, from_s) - 1);
      const last = Math.min(series.s_m.length - 1, bisectLeft(series.s_m, to_s));
      add_driven(bins, series, this.full_scale_m, this.origin, first, last);
    }
    return bins;
  }

  private show_range(range: [number, number]|null): void {
    this.focus = range && this.has_driven ? this.driven_between(...range) : null;
    this.draw();
  }

  private hover(px: number, py: number): void {
    const t = this.transform();
    const [x, y] = this.view.to_ground((px - t.x) / t.k, (py - t.y) / t.k);
    this.readout.textContent = coordinates_text(x, y, this.scene.in_base);
    const found = this.nearest_of_all(x, y);
    this.link.set('cursor', found ? {s: this.vehicles[found.vehicle]!.series.s_m[found.sample]!, vehicle: found.vehicle} : null);
    this.tip.hidden = !found;
    if (!found) return;
    const {name, series} = this.vehicles[found.vehicle]!;
    this.tip.replaceChildren(...sample_rows(series, found.sample, this.vehicles.length > 1 ? name : ''));
    const [tx, ty] = this.to_screen(series.x_m[found.sample]!, series.y_m[found.sample]!);
    const right = tx + 24 + this.tip.offsetWidth < this.overlay.clientWidth;
    this.tip.style.left = `${right ? tx + 16 : Math.max(4, tx - 16 - this.tip.offsetWidth)}px`;
    this.tip.style.top = `${Math.max(4, Math.min(ty + 12, this.overlay.clientHeight - this.tip.offsetHeight - 4))}px`;
  }

  private nearest_of_all(x: number, y: number): {vehicle: number, sample: number}|null {
    let found: {vehicle: number, sample: number}|null = null;
    let limit = kGrab / this.scale();
    this.vehicles.forEach(({series}, vehicle) => {
      const sample = nearest_sample(series.x_m, series.y_m, x, y, limit);
      if (sample < 0) return;
      found = {vehicle, sample};
      limit = Math.hypot(series.x_m[sample]! - x, series.y_m[sample]! - y);
    });
    return found;
  }

  /// Makes the metre, counted from the origin, the context's unit; `draw` paints within.
  private in_metres(context: CanvasRenderingContext2D, draw: (scale: number) => void): void {
    const scale = this.scale();
    const [x, y] = this.to_screen(...this.origin);
    context.save();
    context.translate(x, y);
    context.scale(scale, -scale);
    context.lineJoin = context.lineCap = 'round';
    draw(scale);
    context.restore();
  }

  private paint(): void {
    const context = begin_drawing(this.ground);
    if (!context) return;
    const theme = this.theme();
    const shown = this.layers.filter((layer) => !this.hidden.has(layer));
    this.in_metres(context, (scale) => {
      for (const layer of shown) {
        if (layer.key === 'terrain') this.relief?.paint(context, this.origin, theme.dark);
        else if (layer.key === 'driven') this.paint_driven(context, layer, scale, theme);
        else this.paint_ground(context, layer, scale, theme);
      }
    });
    this.paint_marks(context, shown, theme);
    const {clientWidth: width, clientHeight: height} = this.ground;
    paint_scale_bar(context, height, this.scale(), theme);
    paint_direction(context, this.scene.in_base ? 'ahead' : 'north', theme);
    paint_color_bars(context, width, height, this.color_bars(shown, theme), theme);
  }

  private color_bars(shown: Layer[], theme: Theme): ColorBar[] {
    const bars: ColorBar[] = [];
    if (this.has_driven && shown.some((layer) => layer.key === 'driven')) {
      bars.push({title: 'Cross-track error [mm]', short: '|error| [mm]', color: (t) => ramp(t, theme.dark), low: '0',
                 high: '\u2265 ' + number(1000 * this.full_scale_m)});
    }
    if (this.terrain && shown.some((layer) => layer.key === 'terrain')) {
      bars.push({title: 'Height [m]', short: 'Height [m]', color: (t) => tint_text(t, theme.dark),
                 low: fixed(this.terrain.low_m, 1), high: fixed(this.terrain.high_m, 1)});
    }
    return bars;
  }

  // Below a driven path the planned one is a soft band, so that both can be seen.
  private paint_ground(context: CanvasRenderingContext2D, layer: Layer, scale: number, theme: Theme): void {
    const band = this.has_driven && /^(plan|vehicle)_/.test(layer.key);
    const on_relief = layer.fill !== undefined && this.layers.some((l) => l.key === 'terrain' && !this.hidden.has(l));
    const fleet = this.vehicles.length > 1; // whose band alone tells whose driven path it is
    const width = fleet ? kFleetBand : Math.min(7, kBandWidth * scale);
    context.globalAlpha = band ? (fleet ? 0.6 : 0.32) : on_relief ? kFillOnRelief : 1;
    paint_layer(context, band ? {...layer, width, dash: []} : layer, this.paths.get(layer)!, scale, theme);
    context.globalAlpha = 1;
  }

  private paint_driven(context: CanvasRenderingContext2D, layer: Layer, scale: number, theme: Theme): void {
    const stroke = (bins: Path2D[]) => bins.forEach((bin, i) => {
      context.strokeStyle = ramp((i + 0.5) / kBins, theme.dark);
      context.stroke(bin);
    });
    context.lineWidth = (layer.width ?? 2) / scale;
    context.globalAlpha = this.focus ? 0.18 : 1;
    stroke(this.driven);
    context.globalAlpha = 1;
    if (this.focus) stroke(this.focus);
  }

  private paint_marks(context: CanvasRenderingContext2D, shown: Layer[], theme: Theme): void {
    const labels = new Labels(context, theme);
    if (this.vehicles.length > 1) this.paint_starts(context, shown, theme);
    for (const f of this.features) {
      const layer = this.set.of(f);
      if (f.type !== 'Point' || !shown.includes(layer)) continue;
      const [x, y] = this.to_screen(...(f.coordinates as Position));
      paint_mark(context, layer.mark ?? 'diamond', x, y, theme.get(layer.stroke ?? 'muted'), theme.get('map-ground'));
      const text = f.name || f.id;
      if (text && f.t_s === undefined) labels.write(text, x + 12, y);
    }
  }

  // Where the vehicles of a fleet start, below the marks of places.
  private paint_starts(context: CanvasRenderingContext2D, shown: Layer[], theme: Theme): void {
    this.vehicles.forEach(({series}, i) => {
      if (series.x_m.length === 0 || !shown.some((layer) => layer.key === `vehicle_${i}`)) return;
      const [x, y] = this.to_screen(series.x_m[0]!, series.y_m[0]!);
      paint_dot(context, x, y, series_color(i, theme), theme);
    });
  }

  // What is where, what is headed for, and what happens.
  private paint_moment(context: CanvasRenderingContext2D, time: number, theme: Theme): void {
    this.in_metres(context, (scale) => {
      const goals = this.vehicles.filter(({series}) => plays(series)).flatMap(({series}) => {
        const leg = series.leg[motion_at(series, time).sample];
        return this.features.filter((f) => f.kind === 'goal' && f.leg === leg);
      });
      context.strokeStyle = theme.get('accent');
      context.lineWidth = 2.5 / scale;
      context.stroke(make_path(goals, this.origin));
      this.moving.paint(context, this.origin, scale, time, theme);
    });
    for (const f of this.features) {
      if (f.t_s === undefined || Math.abs(time - f.t_s) > kEventShown) continue;
      context.beginPath();
      context.arc(...this.to_screen(...(f.coordinates as Position)), 13, 0, 2 * Math.PI);
      context.strokeStyle = theme.get(this.set.of(f).stroke ?? 'muted');
      context.lineWidth = 3;
      context.stroke();
    }
  }

  private paint_overlay(): void {
    const context = begin_drawing(this.overlay);
    if (!context) return;
    const theme = this.theme();
    const {cursor, leg, time} = this.link.current;
    if (leg !== null) {
      this.in_metres(context, (scale) => {
        context.strokeStyle = theme.get('accent');
        context.globalAlpha = 0.35;
        context.lineWidth = 10 / scale;
        context.stroke(make_path(this.leg_features(leg), this.origin));
      });
    }
    if (time !== null) this.paint_moment(context, time, theme);
    if (cursor === null) return;
    this.vehicles.forEach(({series}, i) => {
      if (series.x_m.length === 0 || (cursor.vehicle ?? i) !== i) return;
      const sample = nearest(series.s_m, cursor.s);
      paint_dot(context, ...this.to_screen(series.x_m[sample]!, series.y_m[sample]!),
                this.vehicles.length > 1 ? series_color(i, theme) : theme.get('accent'), theme);
    });
  }
}

// SPDX-License-Identifier: Apache-2.0
// The map: a canvas with pan and zoom, a legend that toggles layers, and a marker shared with the
// plots.
import {select} from 'd3-selection';
import {ZoomTransform, zoom, zoomIdentity, zoomTransform} from 'd3-zoom';
import {bisectLeft} from 'd3-array';

import {Theme, ramp} from './color';
import {begin_drawing, element, once_per_frame} from './dom';
import {error_scale, kBins, make_driven} from './driven';
import {Layer, layer_of, layers_of, lines_of} from './layers';
import {legend} from './legend';
import {Link} from './link';
import {Labels, coordinates_text, make_path, paint_color_bar, paint_layer, paint_mark, paint_north,
        paint_scale_bar} from './map_paint';
import {sample_rows} from './sample';
import {Feature, Position, Series} from './types';
import {Bounds, View, empty_bounds, extend, nearest_sample} from './view';

const kMaxZoom = 400;
const kBandWidth = 0.6; // m; of a plan below a driven path
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

  constructor(private readonly features: Feature[], private readonly series: Series, private readonly link: Link,
              private readonly theme: () => Theme) {
    this.has_driven = series.x_m.length > 1 && series.error_m.length > 0;
    this.layers = layers_of(features, this.has_driven);
    for (const f of features) for (const line of lines_of(f)) for (const [x, y] of line) extend(this.bounds, x, y);
    series.x_m.forEach((x, i) => extend(this.bounds, x, series.y_m[i]!));
    this.origin = [(this.bounds.min_x + this.bounds.max_x) / 2, (this.bounds.min_y + this.bounds.max_y) / 2];
    for (const layer of this.layers) {
      this.paths.set(layer, make_path(features.filter((f) => layer_of(f) === layer), this.origin));
    }
    this.full_scale_m = error_scale(series.error_m);
    if (this.has_driven) {
      this.driven = make_driven(series, this.full_scale_m, this.origin, 0, series.x_m.length - 1);
    }
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
        legend(this.layers, (layer, shown) => {
          if (shown) this.hidden.delete(layer);
          else this.hidden.add(layer);
          this.draw();
        }));
  }

  private connect(): void {
    this.zoom.on('zoom', () => this.repaint());
    select(this.overlay).call(this.zoom).on('dblclick.zoom', null);
    this.overlay.addEventListener('dblclick', () => this.fit());
    this.overlay.addEventListener('pointermove', (event) => this.hover(event.offsetX, event.offsetY));
    this.overlay.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
      this.readout.textContent = '';
      this.link.set('sample', null);
    });
    this.overlay.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => {
      this.view = new View(this.bounds, this.overlay.clientWidth, this.overlay.clientHeight);
      this.repaint();
    }).observe(this.overlay);
    this.link.listen((state, what) => {
      if (what === 'sample') this.draw_overlay();
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

  /// Shows the bounds given, or all.
  private fit(bounds: Bounds|null = null): void {
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

  private leg_bounds(leg: number): Bounds {
    const bounds = empty_bounds();
    for (const f of this.leg_features(leg)) for (const line of lines_of(f)) for (const [x, y] of line) extend(bounds, x, y);
    this.series.leg.forEach((l, i) => l === leg && extend(bounds, this.series.x_m[i]!, this.series.y_m[i]!));
    return bounds;
  }
  private leg_features(leg: number): Feature[] {
    return this.features.filter((f) => f.leg === leg);
  }

  private show_range(range: [number, number]|null): void {
    this.focus = null;
    if (range && this.has_driven) {
      const last = this.series.s_m.length - 1;
      const first = Math.max(0, bisectLeft(this.series.s_m, range[0]) - 1);
      this.focus = make_driven(this.series, this.full_scale_m, this.origin, first,
                               Math.min(last, bisectLeft(this.series.s_m, range[1])));
    }
    this.draw();
  }

  private hover(px: number, py: number): void {
    const t = this.transform();
    const [x, y] = this.view.to_ground((px - t.x) / t.k, (py - t.y) / t.k);
    this.readout.textContent = coordinates_text(x, y);
    const sample = nearest_sample(this.series.x_m, this.series.y_m, x, y, kGrab / this.scale());
    this.link.set('sample', sample < 0 ? null : sample);
    this.tip.hidden = sample < 0;
    if (sample < 0) return;
    this.tip.replaceChildren(...sample_rows(this.series, sample));
    const [tx, ty] = this.to_screen(this.series.x_m[sample]!, this.series.y_m[sample]!);
    const right = tx + 24 + this.tip.offsetWidth < this.overlay.clientWidth;
    this.tip.style.left = `${right ? tx + 16 : Math.max(4, tx - 16 - this.tip.offsetWidth)}px`;
    this.tip.style.top = `${Math.max(4, Math.min(ty + 12, this.overlay.clientHeight - this.tip.offsetHeight - 4))}px`;
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
        if (layer.key === 'driven') this.paint_driven(context, layer, scale, theme);
        else this.paint_ground(context, layer, scale, theme);
      }
    });
    this.paint_marks(context, shown, theme);
    const {clientWidth: width, clientHeight: height} = this.ground;
    paint_scale_bar(context, height, this.scale(), theme);
    paint_north(context, theme);
    if (this.has_driven && shown.some((l) => l.key === 'driven')) {
      paint_color_bar(context, width, height, this.full_scale_m, theme);
    }
  }

  // Below a driven path the planned one is a soft band, so that both can be seen.
  private paint_ground(context: CanvasRenderingContext2D, layer: Layer, scale: number, theme: Theme): void {
    const band = this.has_driven && layer.key.startsWith('plan_');
    context.globalAlpha = band ? 0.32 : 1;
    paint_layer(context, band ? {...layer, width: Math.min(7, kBandWidth * scale), dash: []} : layer, this.paths.get(layer)!, scale, theme);
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
    for (const f of this.features) {
      const layer = layer_of(f);
      if (f.type !== 'Point' || !shown.includes(layer)) continue;
      const [x, y] = this.to_screen(...(f.coordinates as Position));
      paint_mark(context, layer.mark ?? 'diamond', x, y, theme.get(layer.stroke ?? 'muted'), theme.get('map-ground'));
      const text = f.name || f.id;
      if (text) labels.write(text, x + 12, y);
    }
  }

  private paint_overlay(): void {
    const context = begin_drawing(this.overlay);
    if (!context) return;
    const theme = this.theme();
    const {sample, leg} = this.link.current;
    if (leg !== null) {
      this.in_metres(context, (scale) => {
        context.strokeStyle = theme.get('accent');
        context.globalAlpha = 0.35;
        context.lineWidth = 10 / scale;
        context.stroke(make_path(this.leg_features(leg), this.origin));
      });
    }
    if (sample === null || sample >= this.series.x_m.length) return;
    const [x, y] = this.to_screen(this.series.x_m[sample]!, this.series.y_m[sample]!);
    context.beginPath();
    context.arc(x, y, 6.5, 0, 2 * Math.PI);
    context.fillStyle = theme.get('accent');
    context.strokeStyle = theme.get('card');
    context.lineWidth = 2.5;
    context.fill();
    context.stroke();
  }
}

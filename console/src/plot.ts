// SPDX-License-Identifier: Apache-2.0
// A plot on a canvas: lines or points over x, a cursor, and a stretch of x to look at, which
// several plots may share.
import {bisectLeft} from 'd3-array';
import {Scale, scaleLinear, scaleLog} from 'd3-scale';

import {Theme, series_color, series_name} from './color';
import {begin_drawing, element, once_per_frame} from './dom';
import {number} from './format';
import {font, paint_mark} from './map_paint';
import {line_points} from './thin';
import {PlotData, PlotSeries} from './types';

export interface PlotOptions {
  references?: {value: number, label: string}[]; // level lines, such as the reserve
  mark_label?: string;                           // what the series' marks are
  with_zero?: boolean;                        // zero is part of the axis
  y_format?: (value: number) => string;
  height?: number; // [px]
  left?: number;   // least room for the numbers of the axis [px]: plots above each other line up
}

/// What plots share: the x under the pointer, and the stretch of x shown (null: all).
export interface Shared {
  cursor(): number|null;
  set_cursor(x: number|null): void;
  range(): [number, number]|null;
  set_range(range: [number, number]|null): void;
}

/// What the page needs of anything that draws: when the theme changes, and before it is printed.
export interface Part {
  root: HTMLElement;
  repaint(): void;
  repaint_now(): void;
}

const kTop = 8;
const kRight = 12;
const kBottom = 22;

export class Plot {
  readonly root: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly overlay: HTMLCanvasElement;
  private readonly values: HTMLElement[] = [];
  private readonly all_x: [number, number];
  private readonly y_domain: [number, number];
  private x: Scale = scaleLinear();
  private y: Scale = scaleLinear();
  private brush: [number, number]|null = null; // [px]
  private readonly draw = once_per_frame(() => this.paint());
  private readonly draw_overlay = once_per_frame(() => this.paint_overlay());

  constructor(private readonly data: PlotData, private readonly options: PlotOptions,
              private readonly shared: Shared, private readonly theme: () => Theme) {
    this.canvas = element('canvas', {'aria-hidden': 'true'});
    this.overlay = element('canvas', {
      tabindex: '0', role: 'img',
      'aria-label': `${data.title}: ${data.y_label} over ${data.x_label}. Left and right move the cursor, ` +
          'plus and minus zoom, 0 shows all.',
    });
    this.all_x = extent(data.series.flatMap((s) => ends(s.x)));
    this.y_domain = this.find_y_domain();
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
  repaint_cursor(): void {
    this.draw_overlay();
  }

  private build(): HTMLElement {
    const several = this.data.series.length > 1;
    const key = element('div', {class: 'plot-key'}, ...this.data.series.map((series, i) => {
      const value = element('output', {});
      this.values.push(value);
      const dot = element('i', {'aria-hidden': 'true', style: key_style(series_name(i), series.dash)});
      return element('span', {}, ...(several ? [dot, series.name] : []), value);
    }));
    if (this.options.mark_label && this.data.series.some((s) => s.marks?.length)) {
      key.prepend(element('span', {}, element('i', {class: 'mark', 'aria-hidden': 'true'}), this.options.mark_label));
    }
    const frame = element('div', {class: 'plot-frame', style: `height: ${this.options.height ?? 240}px`},
        this.canvas, this.overlay);
    return element('figure', {class: 'plot'},
        element('figcaption', {}, element('span', {class: 'plot-title'}, this.data.title),
            element('span', {class: 'unit'}, this.data.y_label), key),
        frame);
  }

  private connect(): void {
    const at = (event: PointerEvent) => this.x.invert(this.clamp(event.offsetX));
    this.overlay.addEventListener('pointermove', (event) => {
      if (this.brush) this.brush = [this.brush[0], this.clamp(event.offsetX)];
      this.shared.set_cursor(at(event));
      this.draw_overlay();
    });
    this.overlay.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      this.overlay.setPointerCapture(event.pointerId);
      this.brush = [this.clamp(event.offsetX), this.clamp(event.offsetX)];
    });
    this.overlay.addEventListener('pointerup', () => {
      const brush = this.brush;
      this.brush = null;
      if (brush && Math.abs(brush[1] - brush[0]) > 6) {
        const [a, b] = brush.map((px) => this.x.invert(px)) as [number, number];
        this.shared.set_range([Math.min(a, b), Math.max(a, b)]);
      }
      this.draw_overlay();
    });
    this.overlay.addEventListener('pointercancel', () => (this.brush = null, this.draw_overlay()));
    this.overlay.addEventListener('pointerleave', () => this.shared.set_cursor(null));
    this.overlay.addEventListener('blur', () => this.shared.set_cursor(null));
    this.overlay.addEventListener('dblclick', () => this.shared.set_range(null));
    this.overlay.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.repaint()).observe(this.overlay);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [low, high] = this.shared.range() ?? this.all_x;
    const span = high - low;
    const cursor = this.shared.cursor() ?? (low + high) / 2;
    const zoom = (factor: number) => {
      const begin = Math.max(this.all_x[0], cursor - (cursor - low) * factor);
      const end = Math.min(this.all_x[1], cursor + (high - cursor) * factor);
      this.shared.set_range(factor > 1 && end - begin >= this.all_x[1] - this.all_x[0] ? null : [begin, end]);
    };
    const move = (step: number) => this.shared.set_cursor(Math.min(high, Math.max(low, cursor + step)));
    const actions: Record<string, () => void> = {
      ArrowLeft: () => move(-span / 200), ArrowRight: () => move(span / 200),
      '+': () => zoom(0.6), '=': () => zoom(0.6), '-': () => zoom(1 / 0.6),
      '0': () => this.shared.set_range(null), Escape: () => this.shared.set_range(null),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  private clamp(px: number): number {
    const [left, right] = this.x_pixels;
    return Math.min(right, Math.max(left, px));
  }
  private x_pixels: [number, number] = [0, 1];

  private find_y_domain(): [number, number] {
    const values = this.data.series.flatMap((s) => ends(s.y.filter((v): v is number => v !== null && (!this.data.log_y || v > 0))));
    values.push(...(this.options.references ?? []).map((reference) => reference.value));
    if (this.options.with_zero) values.push(0);
    const [low, high] = extent(values);
    if (low !== high) return [low, high];
    return this.data.log_y ? [low / 2, high * 2] : [low - (Math.abs(low) * 0.1 || 1), high + (Math.abs(high) * 0.1 || 1)];
  }

  private paint(): void {
    const context = begin_drawing(this.canvas);
    if (!context) return;
    const theme = this.theme();
    const {clientWidth: width, clientHeight: height} = this.canvas;
    context.font = font(11.5);
    this.y = (this.data.log_y ? scaleLog() : scaleLinear()).domain(this.y_domain).range([height - kBottom, kTop]);
    const count = Math.max(2, Math.floor(height / 44));
    this.y.nice(count);
    const y_ticks = this.y_ticks(count);
    const left = Math.ceil(Math.max(this.options.left ?? 24, ...y_ticks.map(([, text]) => context.measureText(text).width)) + 10);
    this.x_pixels = [left, width - kRight];
    this.x = scaleLinear().domain(this.shared.range() ?? this.all_x).range(this.x_pixels);
    if (this.data.x_label === 'x [m]' && this.data.y_label === 'y [m]') this.equalise();
    this.paint_axes(context, this.y_ticks(count), theme, width, height);
    context.save();
    context.beginPath();
    context.rect(left - 4, 0, width - kRight - left + 8, height - kBottom + 4);
    context.clip();
    this.data.series.forEach((series, i) => this.paint_series(context, series, series_color(i, theme)));
    for (const reference of this.options.references ?? []) this.paint_reference(context, reference, theme);
    this.data.series.forEach((series, i) => (series.marks ?? []).forEach(([x, y]) => paint_mark(
        context, 'bolt', this.x(x), this.y(y), series_color(i, theme), theme.get('card'))));
    context.restore();
  }

  // A drawing of places: a metre is as long upwards as sideways.
  private equalise(): void {
    const metres_per_pixel = (scale: Scale): number => {
      const [low, high] = scale.domain() as [number, number];
      const [begin, end] = scale.range() as [number, number];
      return (high - low) / Math.abs(end - begin);
    };
    const coarser = Math.max(metres_per_pixel(this.x), metres_per_pixel(this.y));
    for (const scale of [this.x, this.y]) {
      const [low, high] = scale.domain() as [number, number];
      const widen = 0.5 * (high - low) * (coarser / metres_per_pixel(scale) - 1);
      scale.domain([low - widen, high + widen]);
    }
  }

  private y_ticks(count: number): [number, string][] {
    const format = this.options.y_format ?? ((value: number) => number(value, 4));
    let ticks = this.y.ticks(count);
    if (this.data.log_y && ticks.length > 6) {
      ticks = ticks.filter((t) => Math.abs(Math.log10(t) - Math.round(Math.log10(t))) < 1e-9);
    }
    return ticks.map((t) => [t, format(t)]);
  }

  private paint_axes(context: CanvasRenderingContext2D, y_ticks: [number, string][], theme: Theme, width: number,
                     height: number): void {
    const [left, right] = this.x_pixels;
    context.lineWidth = 1;
    context.textBaseline = 'middle';
    context.textAlign = 'right';
    for (const [value, text] of y_ticks) {
      const y = Math.round(this.y(value)) + 0.5;
      context.strokeStyle = theme.get(value === 0 ? 'axis' : 'grid');
      context.beginPath();
      context.moveTo(left, y);
      context.lineTo(right, y);
      context.stroke();
      context.fillStyle = theme.get('muted');
      context.fillText(text, left - 8, y);
    }
    context.textBaseline = 'alphabetic';
    const label_width = context.measureText(this.data.x_label).width;
    context.fillText(this.data.x_label, width - kRight, height - 5);
    context.textAlign = 'center';
    for (const value of this.x.ticks(Math.max(2, Math.floor((right - left) / 90)))) {
      const x = this.x(value);
      if (x < right - label_width - 26) context.fillText(number(value, 6), x, height - 5);
    }
    context.textAlign = 'left';
  }

  private paint_series(context: CanvasRenderingContext2D, series: PlotSeries, color: string): void {
    context.strokeStyle = context.fillStyle = color;
    const y_of = (value: number|null) => value === null || (this.data.log_y && value <= 0) ? null : this.y(value);
    if (series.style === 'points') {
      series.x.forEach((x, i) => {
        const y = y_of(series.y[i]!);
        if (y === null) return;
        context.beginPath();
        context.arc(this.x(x), y, 3, 0, 2 * Math.PI);
        context.globalAlpha = 0.75;
        context.fill();
      });
      context.globalAlpha = 1;
      return;
    }
    context.lineWidth = 1.6;
    context.lineJoin = 'round';
    context.setLineDash(series.dash ?? []);
    context.beginPath();
    let pen = false;
    for (const [px, py] of line_points(series, this.x, y_of, this.x_pixels)) {
      if (py === null) pen = false;
      else if (pen) context.lineTo(px, py);
      else context.moveTo(px, py), pen = true;
    }
    context.stroke();
    context.setLineDash([]);
  }

  private paint_reference(context: CanvasRenderingContext2D, reference: {value: number, label: string},
                          theme: Theme): void {
    const [left, right] = this.x_pixels;
    const y = Math.round(this.y(reference.value)) + 0.5;
    context.strokeStyle = context.fillStyle = theme.get('bad');
    context.setLineDash([5, 4]);
    context.lineWidth = 1.2;
    context.beginPath();
    context.moveTo(left, y);
    context.lineTo(right, y);
    context.stroke();
    context.setLineDash([]);
    context.font = font(11, 500);
    context.textAlign = 'left';
    context.fillText(reference.label, left + 6, y - 5);
  }

  private paint_overlay(): void {
    const cursor = this.shared.cursor();
    this.show_values(cursor);
    const context = begin_drawing(this.overlay);
    if (!context) return;
    const theme = this.theme();
    const bottom = this.overlay.clientHeight - kBottom;
    if (this.brush) {
      context.fillStyle = theme.get('accent');
      context.globalAlpha = 0.15;
      context.fillRect(this.brush[0], 0, this.brush[1] - this.brush[0], bottom);
      context.globalAlpha = 1;
    }
    if (cursor === null) return;
    const x = Math.round(this.x(cursor)) + 0.5;
    if (x < this.x_pixels[0] || x > this.x_pixels[1] + 1) return;
    context.strokeStyle = theme.get('muted');
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, bottom);
    context.stroke();
    this.data.series.forEach((series, i) => {
      const value = series.y[nearest(series.x, cursor)];
      if (value === null || value === undefined || (this.data.log_y && value <= 0)) return;
      context.beginPath();
      context.arc(x, this.y(value), 3.5, 0, 2 * Math.PI);
      context.fillStyle = series_color(i, theme);
      context.strokeStyle = theme.get('card');
      context.lineWidth = 1.5;
      context.fill();
      context.stroke();
    });
  }

  private show_values(cursor: number|null): void {
    const format = this.options.y_format ?? ((value: number) => number(value, 4));
    this.data.series.forEach((series, i) => {
      const value = cursor === null ? null : series.y[nearest(series.x, cursor)];
      this.values[i]!.textContent = value === null || value === undefined ? '' : format(value);
    });
  }
}

/// A dash of a plot's key.
export function key_style(color: string, dash: number[] = []): string {
  let end = 0;
  const stops = dash.map((length, i) => `${i % 2 ? 'transparent' : `var(--${color})`} ${end}px ${end += length}px`);
  return 'background: ' + (stops.length ? `repeating-linear-gradient(90deg, ${stops.join(', ')})` : `var(--${color})`);
}

/// Index of the value nearest to x in a rising list.
export function nearest(values: number[], x: number): number {
  const right = Math.min(bisectLeft(values, x), values.length - 1);
  return right > 0 && x - values[right - 1]! < values[right]! - x ? right - 1 : right;
}

function extent(values: number[]): [number, number] {
  const [low = 0, high = 1] = ends(values);
  return [low, high];
}

// Lowest and highest; nothing of nothing.
function ends(values: number[]): number[] {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [];
}

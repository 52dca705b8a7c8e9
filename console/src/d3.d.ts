// SPDX-License-Identifier: Apache-2.0
// The few functions of Debian's D3 5 that the page uses (Debian ships no types for them).

declare module 'd3-selection' {
  export interface Selection<E extends Element> {
    call(f: (selection: Selection<E>) => void): this;
    call<A extends unknown[]>(f: (selection: Selection<E>, ...args: A) => void, ...args: A): this;
    on(type: string, listener: (() => void) | null): this;
    node(): E;
  }
  export function select<E extends Element>(element: E): Selection<E>;
}

declare module 'd3-zoom' {
  import {Selection} from 'd3-selection';
  export interface ZoomTransform {
    readonly k: number;
    readonly x: number;
    readonly y: number;
    translate(x: number, y: number): ZoomTransform;
    scale(k: number): ZoomTransform;
  }
  export const zoomIdentity: ZoomTransform;
  export function zoomTransform(element: Element): ZoomTransform;
  export interface Zoom<E extends Element> {
    (selection: Selection<E>): void;
    scaleExtent(extent: [number, number]): this;
    extent(extent: () => [[number, number], [number, number]]): this;
    on(type: string, listener: () => void): this;
    scaleBy(selection: Selection<E>, factor: number): void;
    translateBy(selection: Selection<E>, x: number, y: number): void;
    transform(selection: Selection<E>, transform: ZoomTransform): void;
  }
  export function zoom<E extends Element>(): Zoom<E>;
}

declare module 'd3-scale' {
  export interface Scale {
    (value: number): number;
    domain(): number[];
    domain(domain: [number, number]): this;
    range(): number[];
    range(range: [number, number]): this;
    invert(position: number): number;
    nice(count?: number): this;
    ticks(count?: number): number[];
    tickFormat(count?: number, specifier?: string): (value: number) => string;
  }
  export function scaleLinear(): Scale;
  export function scaleLog(): Scale;
}

declare module 'd3-array' {
  export function bisectLeft(values: ArrayLike<number>, x: number, lo?: number, hi?: number): number;
  export function ticks(start: number, stop: number, count: number): number[];
}

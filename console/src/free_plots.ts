// SPDX-License-Identifier: Apache-2.0
// Plots of a study: each on its own, with its own cursor and zoom.
import {Theme} from './color';
import {element} from './dom';
import {Part, Plot, Shared} from './plot';
import {PlotData} from './types';

export function free_plot(data: PlotData, theme: () => Theme): Part {
  let cursor: number|null = null;
  let range: [number, number]|null = null;
  const shared: Shared = {
    cursor: () => cursor,
    set_cursor: (x) => (cursor = x, plot.repaint_cursor()),
    range: () => range,
    set_range: (r) => (range = r, plot.repaint()),
  };
  const plot = new Plot(data, {height: 280}, shared, theme);
  return {root: element('section', {class: 'card'}, plot.root), repaint: () => plot.repaint(),
          repaint_now: () => plot.repaint_now()};
}

// SPDX-License-Identifier: Apache-2.0
// A map and the plots of what is driven on it, side by side.
import {Theme} from './color';
import {element} from './dom';
import {Link} from './link';
import {MapView} from './map';
import {Part} from './plot';
import {run_plots} from './run_plots';
import {Episode, Scene} from './types';

export function has_map(scene: Scene): boolean {
  return scene.map.features.length > 0 || scene.vehicles.some((vehicle) => vehicle.series.x_m.length > 0);
}

/// The scene's card or cards, or null where there is nothing to be seen.
export function scene_view(scene: Scene, link: Link, theme: () => Theme): Part|null {
  const parts: Part[] = has_map(scene) ? [new MapView(scene, link, theme)] : [];
  const plots = run_plots(scene.vehicles, link, theme);
  if (plots) parts.push(plots);
  if (parts.length === 0) return null;
  return {
    root: element('div', {class: parts.length > 1 ? 'pair' : 'single'}, ...parts.map((part) => part.root)),
    repaint: () => parts.forEach((part) => part.repaint()),
    repaint_now: () => parts.forEach((part) => part.repaint_now()),
  };
}

/// One of several scenes, to be chosen from a list.
export function episodes_view(episodes: Episode[], theme: () => Theme): Part {
  let shown: Part|null = null;
  const place = element('div');
  const show = (i: number) => {
    shown = scene_view(episodes[i]!.scene, new Link(episodes[i]!.scene), theme);
    place.replaceChildren(...(shown ? [shown.root] : []));
  };
  const list = element('select', {'aria-label': 'Episode'}, ...episodes.map(
      ({name, note}, i) => element('option', {value: String(i)}, note ? `${name}: ${note}` : name)));
  list.addEventListener('change', () => show(Number(list.value)));
  show(0);
  return {
    root: element('section', {class: 'episodes', 'aria-label': 'Episodes'},
        element('header', {class: 'card-head'}, element('h2', {}, 'Episodes'), list), place),
    repaint: () => shown?.repaint(),
    repaint_now: () => shown?.repaint_now(),
  };
}

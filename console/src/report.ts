// SPDX-License-Identifier: Apache-2.0
// Puts the page together from the JSON that stands in it.
import {current_theme} from './color';
import {element} from './dom';
import {free_plot} from './free_plots';
import {Link} from './link';
import {Part} from './plot';
import {episodes_view, has_map, scene_view} from './scene';
import {page_head, tiles} from './summary';
import {table} from './table';
import {Report} from './types';
import {why} from './why';

type Choice = 'auto'|'light'|'dark';
const kChoices: Choice[] = ['auto', 'light', 'dark'];

function choose_theme(choice: Choice): void {
  if (choice === 'auto') document.documentElement.removeAttribute('data-theme');
  else document.documentElement.setAttribute('data-theme', choice);
}

function build(report: Report): void {
  let theme = current_theme();
  const get_theme = () => theme;
  const parts: Part[] = [];
  const repaint = () => {
    theme = current_theme();
    for (const part of parts) part.repaint();
  };

  const asked = new URLSearchParams(location.search).get('theme') as Choice;
  let choice: Choice = kChoices.includes(asked) ? asked : 'auto';
  choose_theme(choice);
  theme = current_theme();
  const button = element('button', {type: 'button', class: 'quiet theme'}, `Theme: ${choice}`);
  button.addEventListener('click', () => {
    choice = kChoices[(kChoices.indexOf(choice) + 1) % kChoices.length]!;
    button.textContent = `Theme: ${choice}`;
    choose_theme(choice);
    repaint();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', repaint);
  addEventListener('beforeprint', () => {
    choose_theme('light');
    theme = current_theme();
    for (const part of parts) part.repaint_now(); // the printer does not wait for a frame
  });
  addEventListener('afterprint', () => (choose_theme(choice), repaint()));

  const link = new Link(report);
  const page: Node[] = [page_head(report, button)];
  if (report.tiles.length) page.push(tiles(report.tiles));
  const names = report.vehicles.map((vehicle) => vehicle.name);
  const shown = (part: Part|null) => part ? (parts.push(part), [part.root]) : [];
  page.push(...shown(scene_view(report, link, get_theme)));
  const grid = element('div', {class: 'plots'});
  for (const data of report.plots) {
    const plot = free_plot(data, get_theme);
    parts.push(plot);
    grid.append(plot.root);
  }
  const tables = report.tables.map((data) => table(data, has_map(report) ? link : null, names));
  if (report.why.length) page.push(why(report.why, names, link));
  // A study's findings come first, its pictures after them.
  page.push(...tables, ...(report.plots.length ? [grid] : []));
  if (report.episodes.length) page.push(...shown(episodes_view(report.episodes, get_theme)));
  if (report.config_yaml) {
    page.push(element('details', {class: 'card'}, element('summary', {}, 'Effective configuration'),
        element('pre', {tabindex: '0'}, report.config_yaml)));
  }
  document.getElementById('report')!.replaceChildren(...page);
}

try {
  build(JSON.parse(document.getElementById('data')!.textContent ?? '') as Report);
} catch (error) {
  document.getElementById('report')!.replaceChildren(
      element('p', {class: 'failure', role: 'alert'}, `This report cannot be shown: ${String(error)}`));
  throw error;
}

// SPDX-License-Identifier: Apache-2.0
import {element} from './dom';
import {Link} from './link';
import {Reason} from './types';

/// What a reason is about: a leg, a vehicle, or neither.
export function subject(reason: Reason, vehicles: string[]): string {
  const parts: string[] = [];
  if (reason.vehicle !== undefined && vehicles.length > 1) parts.push(vehicles[reason.vehicle] ?? '');
  if (reason.leg !== undefined) parts.push(`leg ${reason.leg}`);
  return parts.join(', ');
}

/// Why the plan is as it is: reasons of legs lead to them on the map, those of none come first.
export function why(reasons: Reason[], vehicles: string[], link: Link): HTMLElement {
  const item = (reason: Reason) => {
    const {vehicle = 0, leg} = reason;
    const name = subject(reason, vehicles);
    const about = leg === undefined ? element('span', {class: 'about'}, name || 'Note') :
        element('button', {type: 'button', class: 'link about', title: 'Show on the map',
                           click: () => link.toggle_leg({vehicle, leg})}, name);
    return element('li', {}, about, element('span', {}, reason.text));
  };
  const of_none = reasons.filter((reason) => reason.leg === undefined);
  const of_legs = reasons.filter((reason) => reason.leg !== undefined);
  return element('section', {class: 'card', 'aria-label': 'Why'},
      element('header', {class: 'card-head'}, element('h2', {}, 'Why')),
      element('ul', {class: 'why', tabindex: '0'}, ...of_none.map(item), ...of_legs.map(item)));
}

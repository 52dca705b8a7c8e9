// SPDX-License-Identifier: Apache-2.0
import {element} from './dom';
import {Layer} from './layers';

function swatch(layer: Layer): HTMLElement {
  const variable = (name: string) => `var(--${name})`;
  const node = element('span', {class: 'swatch', 'aria-hidden': 'true'});
  if (layer.key === 'driven') node.classList.add('swatch-ramp');
  else if (layer.mark) {
    node.classList.add('swatch-mark');
    if (layer.mark !== 'square') node.style.borderRadius = '50%';
    node.style.background = variable(layer.stroke!);
  } else if (layer.fill) {
    node.classList.add('swatch-area');
    node.style.background = variable(layer.fill);
    if (layer.stroke) node.style.borderColor = variable(layer.stroke);
  } else {
    node.style.borderTop = `3px ${layer.dash ? 'dashed' : 'solid'} ${variable(layer.stroke!)}`;
  }
  return node;
}

/// Check boxes, one per layer.
export function legend(layers: Layer[], toggle: (layer: Layer, shown: boolean) => void): HTMLElement {
  return element('div', {class: 'legend', role: 'group', 'aria-label': 'Layers of the map'},
      ...layers.map((layer) => {
        const box = element('input', {type: 'checkbox', checked: true});
        box.addEventListener('change', () => toggle(layer, box.checked));
        return element('label', {}, box, swatch(layer), layer.label);
      }));
}

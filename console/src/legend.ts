// SPDX-License-Identifier: Apache-2.0
import {element} from './dom';
import {Layer} from './layers';
import {key_style} from './plot';

function swatch(layer: Layer): HTMLElement {
  const variable = (name: string) => `var(--${name})`;
  const node = element('span', {class: 'swatch', 'aria-hidden': 'true'});
  if (layer.key === 'driven') node.classList.add('swatch-ramp');
  else if (layer.key === 'terrain') node.classList.add('swatch-relief');
  else if (layer.mark) {
    node.classList.add('swatch-mark');
    if (layer.mark !== 'square') node.style.borderRadius = '50%';
    node.style.background = variable(layer.stroke!);
  } else if (layer.fill) {
    node.classList.add('swatch-area');
    node.style.background = variable(layer.fill);
    if (layer.stroke) node.style.borderColor = variable(layer.stroke);
  } else {
    node.classList.add('swatch-line');
    node.setAttribute('style', key_style(layer.stroke!, layer.dash));
  }
  return node;
}

/// Check boxes, one per layer; `labels` by key, where they differ from the layer's own.
export function legend(layers: Layer[], labels: Record<string, string>, toggle: (layer: Layer, shown: boolean) => void): HTMLElement {
  return element('div', {class: 'legend', role: 'group', 'aria-label': 'Layers of the map'},
      ...layers.map((layer) => {
        const box = element('input', {type: 'checkbox', checked: true});
        box.addEventListener('change', () => toggle(layer, box.checked));
        return element('label', {}, box, swatch(layer), labels[layer.key] ?? layer.label);
      }));
}

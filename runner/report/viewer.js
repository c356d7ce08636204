'use strict';
// The viewer: two images of a page, zoomed and moved together.
const kViewer = (() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const one = (selector, root = document) => root.querySelector(selector);

  const viewer = document.getElementById('viewer');
  const bar = one('.bar', viewer);
  const stage = one('.stage', viewer);
  const panes = all('.pane', viewer);
  const handle = one('.handle', viewer);
  const field = name => bar.elements[name];
  const foot = one('.foot', viewer);
  let shots = [];       // of the page that is open
  let view = {x: 0, y: 0, scale: 1};  // image pixel (0, 0) in the pane; screen pixels an image pixel
  let isFitted = true;  // whatever the size of the window
  let border = 0.5;     // of the slider, in widths of the pane
  let isFlipped = false;
  let moved = null;     // where a drag began

  const shotOf = name => shots[Number(field(name).value)];
  const addressOf = shot => shot.dataset.full || one('img', shot).getAttribute('src');
  const titleOf = shot =>
    (shot.dataset.run ? shot.dataset.run + ': ' : '') + shot.dataset.name + ' · ' + shot.dataset.title;
  const mode = () => bar.elements.mode.value;
  const gain = () => 2 ** Number(field('gain').value);
  const exposure = () => Number(field('exposure').value);
  const gamma = () => Number(field('gamma').value);

  // Light above white lies in further pictures, each kStops darker than the one before, and black where that one tells. What is
  // brightest of them is the light, whatever is done to each: so a page shows it that may not read its pictures' pixels.
  const kStops = 4;
  const kLayers = 5;
  const lightOf = shot => (shot.dataset.light || '').split(' ').filter(Boolean);
  const decoded = v => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const encoded = v => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

  for (let i = 0; i < kLayers; ++i) {
    const make = (name, attributes, children = []) => {
      const element = document.createElementNS('http://www.w3.org/2000/svg', name);
      Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
      element.append(...children);
      return element;
    };
    const channels = ['R', 'G', 'B'].map(c => make('feFunc' + c, {type: 'table', class: `exposed-${i}`}));
    one('svg', viewer).append(make('filter', {id: `exposed-${i}`, 'color-interpolation-filters': 'sRGB', x: 0, y: 0, width: 1, height: 1},
                                   [make('feComponentTransfer', {}, channels)]));
  }

  // What a value of a display becomes: a table, exact for its 256 values.
  function expose() {
    field('exposureText').value = `${exposure() > 0 ? '+' : ''}${exposure()}`;
    field('gammaText').value = gamma();
    for (let i = 0; i < kLayers; ++i) {
      const factor = 2 ** (exposure() + kStops * i);
      const shown = v => Math.max(0, Math.min(1, encoded((decoded(v) * factor) ** (1 / gamma()))));
      const table = [...Array(256).keys()].map(v => shown(v / 255).toFixed(4)).join(' ');
      for (const channel of all(`.exposed-${i}`, viewer)) channel.setAttribute('tableValues', table);
    }
    const isExposed = (exposure() !== 0 || gamma() !== 1) && mode() !== 'flip-map';
    for (const picture of all('.picture', stage)) {
      [...picture.children].forEach((image, i) => { image.style.filter = isExposed ? `url(#exposed-${i})` : ''; });
    }
  }

  // Its truth; else the image of that name of another case or run; else its neighbour.
  function partnerOf(shot) {
    const isOther = s => s !== shot;
    const found = shots.find(s => s.id === shot.dataset.truth) ||
                  shots.find(s => isOther(s) && s.dataset.name === shot.dataset.name) ||
                  shots.find(isOther) || shot;
    return shots.indexOf(found);
  }

  // The FLIP map of the pair, whichever of the two is the truth.
  function flipMapOf(a, b) {
    const mapOf = (s, truth) => {
      const map = s.dataset.truth === truth.id && one(`.error[data-of="${s.id}"] img`);
      return map ? map.getAttribute('src') : '';
    };
    return mapOf(a, b) || mapOf(b, a);
  }

  function openViewer(shot, mode) {
    shots = all('.shot', shot.closest('.page'));
    for (const name of ['a', 'b']) {
      field(name).replaceChildren(...shots.map((s, i) => new Option(titleOf(s), i)));
    }
    field('a').value = shots.indexOf(shot);
    field('b').value = partnerOf(shot);
    if (!viewer.open) viewer.showModal();
    if (mode) bar.elements.mode.value = mode;
    isFitted = true;
    load();
  }

  // --- what is seen stands in the address, so that it can be sent: #SHOT?b=OTHER&mode=flip&exposure=-2&at=64,32,4 ---

  const kSettings = ['mode', 'exposure', 'gamma', 'gain'];
  let telling = 0;

  function tellAddress() {
    clearTimeout(telling);  // browsers take no more than so many a second
    telling = setTimeout(() => {
      if (!viewer.open) return;
      const state = new URLSearchParams({b: shotOf('b').id});
      for (const name of kSettings) state.set(name, field(name).value);
      const pane = panes[0].getBoundingClientRect();
      const middle = [pane.width / 2 - view.x, pane.height / 2 - view.y].map(v => (v / view.scale).toFixed(1));
      if (!isFitted) state.set('at', [...middle, view.scale.toFixed(3)].join());
      history.replaceState(null, '', `#${encodeURIComponent(shotOf('a').id)}?${state}`);
    }, 200);
  }

  function followAddress() {
    const [id, state] = location.hash.slice(1).split('?');
    const shot = state && document.getElementById(decodeURIComponent(id));
    if (!shot || !shot.matches('.shot')) return;
    const given = new URLSearchParams(state);
    for (const name of kSettings) if (given.has(name)) field(name).value = given.get(name);
    openViewer(shot);
    const partner = shots.findIndex(s => s.id === given.get('b'));
    if (partner >= 0) field('b').value = partner;
    load();
    const [x, y, scale] = (given.get('at') || '').split(',').map(Number);
    if (!(scale > 0)) return;
    const pane = panes[0].getBoundingClientRect();
    Object.assign(view, {scale, x: pane.width / 2 - x * scale, y: pane.height / 2 - y * scale});
    isFitted = false;
    place();
  }

  function leaveAddress() {
    clearTimeout(telling);
    history.replaceState(null, '', '#' + encodeURIComponent(one('.page.current').id));
  }

  const readers = {};  // canvases to read pixels from, where the browser lets a page read them; one a layer of light

  // The picture, and its light above white over it.
  function fill(picture, sources, width, height) {
    while (picture.children.length > sources.length) picture.lastChild.remove();
    sources.forEach((source, i) => {
      const image = picture.children[i] || picture.appendChild(new Image());
      if (image.getAttribute('src') !== source) image.src = source;
      Object.assign(image, {alt: '', width, height});
    });
  }

  function load() {
    const [a, b] = [shotOf('a'), shotOf('b')];
    const sources = {a: [addressOf(a), ...lightOf(a)], b: [addressOf(b), ...lightOf(b)]};
    const flipMap = flipMapOf(a, b);
    const isMap = mode() === 'flip-map';
    bar.elements.mode[5].disabled = !flipMap;
    if (isMap && !flipMap) bar.elements.mode.value = 'side';
    const [width, height] = ['width', 'height'].map(side => Number(one('img', a).getAttribute(side)));
    for (const name of ['a', 'b']) {
      for (const picture of all('.picture.' + name, stage)) {
        // Of A's size: images of other sizes are stretched over it.
        fill(picture, name === 'a' && isMap && flipMap ? [flipMap] : sources[name], width, height);
      }
      readers[name] = null;
    }
    isFitted = isFitted || width !== view.width || height !== view.height;
    view.width = width;
    view.height = height;
    panes[0].caption = titleOf(a);
    panes[1].caption = titleOf(b);
    const errorsOf = (s, truth) => (s.dataset.truth === truth.id && s.dataset.errors) || '';
    field('error').value = errorsOf(a, b) || errorsOf(b, a);
    show();
    if (isFitted) fit();
  }

  function show() {
    stage.dataset.mode = mode();
    stage.classList.toggle('flipped', isFlipped);
    const other = mode() === 'flip' && isFlipped;
    one('.caption', panes[0]).textContent = {
      side: panes[0].caption, flip: other ? 'B: ' + panes[1].caption : 'A: ' + panes[0].caption,
    }[mode()] || '';
    one('.caption', panes[1]).textContent = panes[1].caption;
    field('gainText').value = gain();
    expose();
    const k = gain();
    for (const channel of all('[id^=gain-] *', viewer)) {  // k (1 − v)
      channel.setAttribute('slope', -k);
      channel.setAttribute('intercept', k);
    }
    one('.layers', panes[0]).style.filter = mode() === 'absolute' ? `brightness(${k})` : '';
    const limit = k === 1 ? '1' : `1/${k}`;
    const legend = {
      signed: [`−${limit}`, limit, 'B − A, mean of the channels as displayed: red where A is darker, blue where it is brighter'],
      absolute: ['0', limit, '|B − A| of each channel as displayed'],
      'flip-map': ['0', '1', 'FLIP at 67 pixels a degree'],
    }[mode()];
    one('.legend', foot).hidden = !legend;
    if (legend) ['low', 'high', 'says'].forEach((c, i) => { one('.' + c, foot).textContent = legend[i]; });
    one('.ramp', foot).dataset.mode = mode();
    place();
  }

  // Puts the images where `view` says, in whole screen pixels so that both panes agree.
  function place() {
    const at = `translate(${Math.round(view.x)}px, ${Math.round(view.y)}px) scale(${view.scale})`;
    for (const layers of all('.layers', stage)) {
      layers.style.transform = at;
      layers.classList.toggle('pixels', view.scale === 1 || view.scale >= 2);
    }
    const pane = panes[0].getBoundingClientRect();
    handle.style.left = `${border * pane.width}px`;
    handle.setAttribute('aria-valuenow', Math.round(100 * border));
    const cut = (border * pane.width - Math.round(view.x)) / view.scale;
    one('.picture.b', panes[0]).style.clipPath = mode() === 'slider' ? `inset(0 0 0 ${Math.max(0, cut)}px)` : '';
    field('zoomText').value = `${Math.round(view.scale * 100)} %`;
    tellAddress();
  }

  function fit() {
    const pane = panes[0].getBoundingClientRect();
    view.scale = Math.min(pane.width / view.width, pane.height / view.height);
    isFitted = true;
    view.x = (pane.width - view.width * view.scale) / 2;
    view.y = (pane.height - view.height * view.scale) / 2;
    place();
  }

  // Keeps what lies under (x, y) of the pane where it is.
  function zoom(factor, x, y) {
    const scale = Math.min(64, Math.max(1 / 16, view.scale * factor));
    view.x = x - (x - view.x) * scale / view.scale;
    view.y = y - (y - view.y) * scale / view.scale;
    view.scale = scale;
    isFitted = false;
    place();
  }

  function paneAt(event) {
    const pane = (event.target.closest && event.target.closest('.pane')) || panes[0];
    const box = pane.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top, width: box.width};
  }

  function pixelOf(name, x, y) {
    try {
      readers[name] ||= all('img', one('.picture.' + name, stage)).map(image => {
        const canvas = document.createElement('canvas');
        canvas.width = view.width;
        canvas.height = view.height;
        const reader = canvas.getContext('2d', {willReadFrequently: true});
        reader.drawImage(image, 0, 0, view.width, view.height);
        return reader;
      });
      const layers = readers[name].map(reader => [...reader.getImageData(x, y, 1, 1).data.slice(0, 3)]);
      const light = [0, 1, 2].map(c => Math.max(...layers.map((layer, i) => decoded(layer[c] / 255) * 2 ** (kStops * i))));
      return layers[0].join(' ') + (layers.length > 1 ? ` (light ${light.map(v => v.toPrecision(3)).join(' ')})` : '');
    } catch {
      return '';  // an image beside the page: browsers show it, but let no page read it
    }
  }

  function tellPixel(event) {
    const at = paneAt(event);
    const x = Math.floor((at.x - view.x) / view.scale);
    const y = Math.floor((at.y - view.y) / view.scale);
    const isInside = x >= 0 && y >= 0 && x < view.width && y < view.height;
    let text = isInside ? `(${x}, ${y})` : '';
    for (const name of isInside && mode() !== 'flip-map' ? ['a', 'b'] : []) {
      const value = pixelOf(name, x, y);
      if (value) text += `  ${name.toUpperCase()} ${value}`;
    }
    one('[name=pixel]', foot).value = text;
  }

  function setMode(index) {
    if (bar.elements.mode[index].disabled) return;
    bar.elements.mode[index].checked = true;
    load();
  }

  function onKey(event) {
    if (event.target.matches('select')) return;  // it finds names by their letters
    const along = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (along && event.target.matches('input')) return;
    const box = panes[0].getBoundingClientRect();
    if (along && event.shiftKey) {
      view.x -= along[0] * box.width / 8;
      view.y -= along[1] * box.height / 8;
      isFitted = false;
      place();
      event.preventDefault();
      return;
    }
    if (along && along[0] && event.target === handle) {
      border = Math.min(1, Math.max(0, border + along[0] / 50));
      place();
      event.preventDefault();
      return;
    }
    const keys = {
      f: () => { isFlipped = !isFlipped; show(); },
      0: fit,
      p: () => zoom(1 / view.scale, box.width / 2, box.height / 2),
      '+': () => zoom(2, box.width / 2, box.height / 2),
      '-': () => zoom(0.5, box.width / 2, box.height / 2),
      ArrowRight: () => step(1),
      ArrowLeft: () => step(-1),
      ArrowDown: () => stepMethod(1),
      ArrowUp: () => stepMethod(-1),
      e: () => turnUp('exposure', 1),
      E: () => turnUp('exposure', -1),
      g: () => turnUp('gamma', 1),
      G: () => turnUp('gamma', -1),
      r: () => { field('exposure').value = 0; field('gamma').value = 1; show(); },
    };
    if (/^[1-6]$/.test(event.key)) setMode(Number(event.key) - 1);
    else if (keys[event.key]) keys[event.key]();
    else return;
    event.preventDefault();
  }

  // To the next image, with its own partner.
  function step(by) {
    const at = (Number(field('a').value) + by + shots.length) % shots.length;
    field('a').value = at;
    field('b').value = partnerOf(shots[at]);
    load();
  }

  // A alone: the same picture by the next method, or the truth of them. They have one truth; without any they share a row.
  function stepMethod(by) {
    const a = shotOf('a');
    const truth = a.dataset.truth || (shots.some(s => s.dataset.truth === a.id) ? a.id : '');
    const row = s => s.closest('tr, .gallery');
    const isLike = s => (truth ? s.id === truth || (s.dataset.truth === truth && (a.id === truth || s.dataset.name === a.dataset.name))
                               : row(s) === row(a) && s.dataset.name === a.dataset.name);
    const alike = shots.filter(isLike);
    field('a').value = shots.indexOf(alike[(alike.indexOf(a) + by + alike.length) % alike.length]);
    load();
  }

  function turnUp(name, steps) {
    if (steps > 0) field(name).stepUp(steps); else field(name).stepDown(-steps);
    show();
  }

  function listenToViewer() {
    const isSlider = element => element.type === 'range';
    bar.addEventListener('change', e => (isSlider(e.target) ? show() : load()));
    bar.addEventListener('input', e => { if (isSlider(e.target)) show(); });
    viewer.addEventListener('close', leaveAddress);
    field('fit').onclick = fit;
    field('pixels').onclick = () => onKey({key: 'p', target: stage, preventDefault() {}});
    viewer.addEventListener('keydown', onKey);
    stage.addEventListener('wheel', e => {
      e.preventDefault();
      const at = paneAt(e);
      zoom(e.deltaY < 0 ? 1.25 : 0.8, at.x, at.y);
    }, {passive: false});
    stage.addEventListener('pointerdown', e => {
      const isHandle = e.target === handle;
      moved = {x: e.clientX, y: e.clientY, view: {...view}, border, isHandle, distance: 0};
      stage.setPointerCapture(e.pointerId);
      e.preventDefault();
    });
    stage.addEventListener('pointermove', e => {
      tellPixel(e);
      if (!moved) return;
      const [dx, dy] = [e.clientX - moved.x, e.clientY - moved.y];
      moved.distance = Math.max(moved.distance, Math.hypot(dx, dy));
      if (moved.isHandle) {
        border = Math.min(1, Math.max(0, moved.border + dx / panes[0].getBoundingClientRect().width));
      } else {
        view.x = moved.view.x + dx;
        view.y = moved.view.y + dy;
        isFitted = false;
      }
      place();
    });
    stage.addEventListener('pointerup', () => {
      const isClick = moved && moved.distance < 3 && !moved.isHandle;
      moved = null;
      if (isClick && mode() === 'flip') {
        isFlipped = !isFlipped;
        show();
      }
    });
    addEventListener('resize', () => { if (viewer.open) (isFitted ? fit : place)(); });
    document.addEventListener('click', e => {
      const shot = e.target.closest('.shot');
      const map = e.target.closest('.error');
      if (shot) openViewer(shot);
      if (map) openViewer(document.getElementById(map.dataset.of), 'flip-map');
    });
  }

  listenToViewer();
  return {followAddress, element: viewer};
})();

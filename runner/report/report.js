'use strict';
// Turns pages, filters claims, shows the cases behind a row, compares images. All numbers are in the HTML.
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const one = (selector, root = document) => root.querySelector(selector);

  // --- pages: one section at a time, by the address's fragment ---

  const pages = all('.page');
  const nav = one('nav.pages');
  const title = document.title;

  function turn() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const page = (target && target.closest('.page')) || pages[0];
    pages.forEach(p => p.classList.toggle('current', p === page));
    const heading = one('h1, h2', page);
    heading.setAttribute('aria-level', 1);  // of what is shown it is the first; a table's page has no h2 below it
    if (page.id !== 'overview') all('h3, h4', page).forEach(h => h.setAttribute('aria-level', h.tagName[1] - 1));
    document.title = page === pages[0] ? title : `${heading.textContent} · ${title}`;
    const at = pages.indexOf(page);
    const link = (anchor, other) => {
      anchor.classList.toggle('off', !other);
      if (other) anchor.href = '#' + other.id; else anchor.removeAttribute('href');
    };
    link(one('.previous', nav), pages[at - 1]);
    link(one('.next', nav), pages[at + 1]);
    one('select', nav).value = page.id;
    hideCases();
    const details = target && target.closest('details');
    if (details) details.open = true;
    if (target && target !== page) target.scrollIntoView(); else window.scrollTo(0, 0);
    return page;
  }

  // Who reads by keyboard goes on from the head of the page, not from the top of the file.
  function turnAndFocus() {
    one('h1, h2', turn()).focus({preventScroll: true});
  }

  // ← and → turn pages where no control, table or viewer takes them.
  function onPageKey(e) {
    if (e.altKey || e.ctrlKey || e.metaKey || e.shiftKey || viewer.open) return;
    if (e.target.closest('input, select, textarea, .scroll')) return;
    const link = {ArrowLeft: '.previous', ArrowRight: '.next'}[e.key];
    const anchor = link && one(link, nav);
    if (anchor && anchor.hasAttribute('href')) location.hash = anchor.getAttribute('href');
  }

  // --- filters over the claims ---

  const filters = one('.filters');
  const claims = all('.said .claim');

  function filter() {
    const wanted = new FormData(filters);
    const verdicts = wanted.getAll('verdict');
    const words = wanted.get('text').trim().toLowerCase();
    const isAll = verdicts.length === all('input[name=verdict]', filters).length && !words && !wanted.get('differ');
    let shown = 0;
    for (const chapter of all('.said .chapter')) {
      for (const page of all('.of-page', chapter)) {
        const isNamed = words && page.dataset.text.toLowerCase().includes(words);
        let count = 0;
        for (const claim of all('.claim', page)) {
          claim.hidden = !(claim.dataset.verdict.split(' ').some(v => verdicts.includes(v)) &&
                           (!wanted.get('origin') || claim.dataset.origin === wanted.get('origin')) &&
                           (!wanted.get('differ') || claim.classList.contains('differs')) &&
                           (!words || isNamed || claim.dataset.text.toLowerCase().includes(words)));
          if (!claim.hidden) ++count;
        }
        const isHere = !wanted.get('paper') || chapter.dataset.paper === wanted.get('paper');
        page.hidden = !isHere || (!count && !isAll && !isNamed);
        if (!page.hidden) shown += count;
      }
      chapter.hidden = all('.of-page', chapter).every(page => page.hidden);
    }
    one('output', filters).value = shown === claims.length ? '' : `${shown} of ${claims.length} claims`;
  }

  // --- the cases behind a row: on pointing or focus; a click keeps them ---

  const aside = one('.cases-shown');
  const kMaxShown = 6;

  function hideCases() {
    aside.hidden = true;
    aside.classList.remove('kept');
    all('.results .pointed').forEach(row => row.classList.remove('pointed'));
  }

  function showCases(row, cell) {
    const ids = new Set();
    for (const td of [cell, ...row.cells]) {
      if (td && td.dataset.cases) td.dataset.cases.split(' ').forEach(id => ids.add(id));
    }
    const articles = [...ids].map(id => document.getElementById(id)).filter(Boolean);
    hideCases();
    if (!articles.length) return;
    row.classList.add('pointed');
    aside.replaceChildren(...articles.slice(0, kMaxShown).map(article => {
      const copy = article.cloneNode(true);
      copy.removeAttribute('id');
      return copy;
    }));
    if (articles.length > kMaxShown) {
      const more = document.createElement('p');
      more.textContent = `and ${articles.length - kMaxShown} more below, under Cases`;
      aside.append(more);
    }
    aside.hidden = false;
  }

  function keepCases(row, cell) {
    const isKept = aside.classList.contains('kept') && row.classList.contains('pointed');
    hideCases();
    if (isKept) return;
    showCases(row, cell);
    if (aside.hidden) return;
    const close = document.createElement('button');
    close.textContent = '✕';
    close.className = 'close';
    close.setAttribute('aria-label', 'close');
    close.onclick = hideCases;
    aside.prepend(close);
    aside.classList.add('kept');
  }

  for (const row of all('.results tbody tr')) {
    if (!one('[data-cases]', row)) continue;
    row.tabIndex = 0;
    const kept = () => aside.classList.contains('kept');
    row.addEventListener('pointerover', e => kept() || showCases(row, e.target.closest('td')));
    row.addEventListener('pointerleave', () => kept() || hideCases());
    row.addEventListener('focus', () => kept() || showCases(row));
    row.addEventListener('blur', () => kept() || hideCases());
    row.addEventListener('click', e => keepCases(row, e.target.closest('td')));
    row.addEventListener('keydown', e => { if (e.key === 'Enter') keepCases(row); });
  }

  // --- curves: a point tells its numbers; a click on a name takes its curve away and brings it back ---

  const tip = document.createElement('div');
  tip.className = 'tip';
  tip.hidden = true;
  document.body.append(tip);
  const kReach = 24;  // pixels from a point

  function leavePoint(svg) {
    tip.hidden = true;
    all('.at', svg).forEach(mark => mark.classList.remove('at'));
  }

  // What a mark says of itself stands in its title, which the browser would show, too, but late.
  function marksOf(svg) {
    for (const title of all('g title, a title', svg)) {
      title.parentNode.dataset.says = title.textContent;
      title.remove();
    }
    return all('[data-says]', svg);
  }

  function tellPoint(svg, event) {
    leavePoint(svg);
    let nearest = null;
    let least = kReach;
    for (const mark of marksOf(svg)) {
      if (mark.closest('.off')) continue;
      const box = mark.getBoundingClientRect();
      const distance = Math.hypot(box.left + box.width / 2 - event.clientX, box.top + box.height / 2 - event.clientY);
      if (distance < least) [nearest, least] = [mark, distance];
    }
    if (!nearest) return;
    nearest.classList.add('at');
    tip.textContent = nearest.dataset.says;
    tip.hidden = false;
    const box = tip.getBoundingClientRect();
    tip.style.left = `${Math.max(4, Math.min(event.clientX + 12, innerWidth - box.width - 8))}px`;
    tip.style.top = `${event.clientY > innerHeight / 2 ? event.clientY - box.height - 12 : event.clientY + 16}px`;
  }

  function switchCurve(figure, which) {
    for (const part of all(`[data-name="${which}"], [data-curve="${which}"]`, figure)) {
      const isOff = part.classList.toggle('off');
      if (part.dataset.name) part.setAttribute('aria-pressed', !isOff);
    }
  }

  for (const figure of all('.curve, .near')) {
    for (const svg of all('svg', figure)) {
      for (const kind of ['pointermove', 'pointerdown']) svg.addEventListener(kind, e => tellPoint(svg, e));
      svg.addEventListener('pointerleave', () => leavePoint(svg));
    }
    for (const name of all('[data-name]', figure)) {
      name.setAttribute('role', 'button');
      name.setAttribute('aria-pressed', true);
      name.setAttribute('tabindex', 0);
      name.addEventListener('click', () => switchCurve(figure, name.dataset.name));
      name.addEventListener('keydown', e => { if (e.key === 'Enter') switchCurve(figure, name.dataset.name); });
    }
  }

  // A click on a command selects it, ready to be copied.
  document.addEventListener('click', e => {
    const command = e.target.closest('.command');
    if (command) getSelection().selectAllChildren(command);
  });

  // --- the viewer: two images of a page, zoomed and moved together ---

  const viewer = document.getElementById('viewer');
  const bar = one('.bar', viewer);
  const stage = one('.stage', viewer);
  const panes = all('.pane', viewer);
  const handle = one('.handle', viewer);
  const field = name => bar.elements[name];
  const foot = one('.foot', viewer);
  let shots = [];       // of the page that is open
  let view = {x: 0, y: 0, scale: 1};  // image pixel (0, 0) in the pane; screen pixels an image pixel
  let border = 0.5;     // of the slider, in widths of the pane
  let isFlipped = false;
  let moved = null;     // where a drag began

  const shotOf = name => shots[Number(field(name).value)];
  const addressOf = shot => shot.dataset.full || one('img', shot).getAttribute('src');
  const titleOf = shot =>
    (shot.dataset.run ? shot.dataset.run + ': ' : '') + shot.dataset.name + ' · ' + shot.dataset.title;
  const mode = () => bar.elements.mode.value;
  const gain = () => 2 ** Number(field('gain').value);

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
    viewer.showModal();
    if (mode) bar.elements.mode.value = mode;
    load();
  }

  const readers = {};  // canvases to read pixels from, where the browser lets a page read them

  function load() {
    const [a, b] = [shotOf('a'), shotOf('b')];
    const sources = {a: addressOf(a), b: addressOf(b)};
    const flipMap = flipMapOf(a, b);
    const isMap = mode() === 'flip-map';
    bar.elements.mode[5].disabled = !flipMap;
    if (isMap && !flipMap) bar.elements.mode.value = 'side';
    const [width, height] = ['width', 'height'].map(side => Number(one('img', a).getAttribute(side)));
    for (const name of ['a', 'b']) {
      for (const image of all('img.' + name, stage)) {
        const source = name === 'a' && isMap && flipMap ? flipMap : sources[name];
        if (image.getAttribute('src') !== source) image.src = source;
        image.width = width;  // of A: images of other sizes are stretched over it
        image.height = height;
      }
      readers[name] = null;
    }
    view.width = width;
    view.height = height;
    panes[0].caption = titleOf(a);
    panes[1].caption = titleOf(b);
    show();
    fit();
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
      layers.classList.toggle('pixels', view.scale >= 1);
    }
    const pane = panes[0].getBoundingClientRect();
    handle.style.left = `${border * pane.width}px`;
    handle.setAttribute('aria-valuenow', Math.round(100 * border));
    const cut = (border * pane.width - Math.round(view.x)) / view.scale;
    one('img.b', panes[0]).style.clipPath = mode() === 'slider' ? `inset(0 0 0 ${Math.max(0, cut)}px)` : '';
    field('zoomText').value = `${Math.round(view.scale * 100)} %`;
  }

  function fit() {
    const pane = panes[0].getBoundingClientRect();
    const scale = Math.min(pane.width / view.width, pane.height / view.height);
    view.scale = scale > 1 ? Math.floor(scale) : scale;
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
    place();
  }

  function paneAt(event) {
    const pane = (event.target.closest && event.target.closest('.pane')) || panes[0];
    const box = pane.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top, width: box.width};
  }

  function pixelOf(name, x, y) {
    try {
      if (!readers[name]) {
        const canvas = document.createElement('canvas');
        canvas.width = view.width;
        canvas.height = view.height;
        readers[name] = canvas.getContext('2d', {willReadFrequently: true});
        readers[name].drawImage(one('img.' + name, stage), 0, 0, view.width, view.height);
      }
      return [...readers[name].getImageData(x, y, 1, 1).data.slice(0, 3)].join(' ');
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
      place();
      event.preventDefault();
      return;
    }
    if (along && event.target === handle) {
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

  function listenToViewer() {
    bar.addEventListener('change', e => (e.target.name === 'gain' ? show() : load()));
    bar.addEventListener('input', e => { if (e.target.name === 'gain') show(); });
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
    addEventListener('resize', () => { if (viewer.open) fit(); });
    document.addEventListener('click', e => {
      const shot = e.target.closest('.shot');
      const map = e.target.closest('.error');
      if (shot) openViewer(shot);
      if (map) openViewer(document.getElementById(map.dataset.of), 'flip-map');
    });
  }

  // On paper a table is as large as its page lets it be: in CSS pixels between the margins of A4, or of Letter across.
  const UPRIGHT = 680, ACROSS = 940;
  const PRINTED = 0.7, LEAST = 0.5;  // of the size on a screen, where it fits; below it a table lies across

  function scaleForPaper() {
    document.body.classList.replace('paged', 'for-paper');  // what is not shown has no width
    const tables = all('.scroll > table');
    tables.forEach(t => { t.style.width = 'min-content'; });
    const widths = tables.map(t => t.offsetWidth);
    tables.forEach((t, i) => {
      t.style.width = '';
      const isAcross = UPRIGHT / widths[i] < LEAST;
      t.parentElement.classList.toggle('across', isAcross);
      t.style.setProperty('--printed', Math.min(PRINTED, (isAcross ? ACROSS : UPRIGHT) / widths[i]));
    });
  }

  // Tables share most of what their paper left open: on paper each of it stands once.
  function sayAssumptionsOnce() {
    const known = new Set();
    for (const table of all('.assumed')) {
      const again = [];
      for (const row of all('tbody tr', table)) {
        const isAgain = known.has(row.innerHTML);
        known.add(row.innerHTML);
        row.classList.toggle('on-screen', isAgain);
        if (isAgain) again.push(row.cells[0].textContent);
      }
      table.classList.toggle('on-screen', again.length === all('tbody tr', table).length);
      if (again.length === 0) continue;
      const line = document.createElement('p');
      line.className = 'small of-paper';
      line.textContent = 'As said before: ' + again.join(', ') + '.';
      table.parentElement.after(line);
    }
  }
  addEventListener('beforeprint', () => {
    scaleForPaper();
    sayAssumptionsOnce();
  });
  addEventListener('afterprint', () => {
    document.body.classList.replace('for-paper', 'paged');
    all('.of-paper').forEach(line => line.remove());
  });

  document.body.classList.add('paged');
  nav.hidden = false;
  one('select', nav).addEventListener('change', e => { location.hash = e.target.value; });
  addEventListener('hashchange', turnAndFocus);
  addEventListener('keydown', onPageKey);
  addEventListener('keydown', e => { if (e.key === 'Escape') hideCases(); });
  filters.hidden = claims.length === 0;
  filters.addEventListener('input', filter);
  filters.addEventListener('submit', e => e.preventDefault());
  listenToViewer();
  filter();
  turn();
})();

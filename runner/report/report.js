'use strict';
// Turns pages, filters claims, shows the cases behind a row. All numbers are in the HTML.
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const one = (selector, root = document) => root.querySelector(selector);

  // --- pages: one section at a time, by the address's fragment ---

  const pages = all('.page');
  const nav = one('nav.pages');
  const title = document.title;

  function turn() {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1).split('?')[0]));
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
    kViewer.followAddress();
  }

  // ← and → turn pages where no control, table or viewer takes them.
  function onPageKey(e) {
    if (e.altKey || e.ctrlKey || e.metaKey || e.shiftKey || kViewer.element.open) return;
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
  filter();
  turn();
  kViewer.followAddress();
})();

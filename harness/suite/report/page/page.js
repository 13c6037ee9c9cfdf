// SPDX-License-Identifier: Apache-2.0
// The script of the report page: filter, search, keyboard, links, one cursor across the rows of a timeline and the 3D
// replay. Without it everything can be read. What it offers to other scripts, window.prehendReport, is described in
// docs/report-page.md.
(function () {
  'use strict';
  const sections = Array.from(document.querySelectorAll('section.scenario'));
  const search = document.getElementById('search');
  const chips = Array.from(document.querySelectorAll('button.chip'));
  const shown = document.getElementById('shown');
  document.getElementById('tools').hidden = false;

  function rowOf(section) { return document.querySelector('tr[data-of="' + CSS.escape(section.id) + '"]'); }
  function textOf(section) {
    if (!section.searched) {
      const parts = Array.from(section.querySelectorAll('h2, div.soft, p, pre, text, title'));
      section.searched = parts.map((part) => part.textContent).join(' ').toLowerCase();
    }
    return section.searched;
  }
  function wanted(section) {
    const pressed = chips.filter((chip) => chip.getAttribute('aria-pressed') === 'true');
    if (pressed.length > 0 && !pressed.some((chip) => chip.dataset.verdict === section.dataset.verdict)) return false;
    const words = search.value.toLowerCase().split(' ').filter(Boolean);
    return words.length === 0 || words.every((word) => textOf(section).includes(word));
  }
  function filter() {
    let count = 0;
    sections.forEach((section) => {
      const keep = wanted(section);
      section.hidden = !keep;
      const row = rowOf(section);
      if (row) row.hidden = !keep;
      if (keep) count += 1;
    });
    shown.textContent = count + ' of ' + sections.length + ' shown';
  }
  search.addEventListener('input', filter);
  chips.forEach((chip) => chip.addEventListener('click', () => {
    chip.setAttribute('aria-pressed', String(chip.getAttribute('aria-pressed') !== 'true'));
    filter();
  }));

  function open(section) {
    section.querySelector('details').open = true;
    section.querySelector('summary').focus({preventScroll: true});
    section.scrollIntoView({block: 'start'});
  }
  let at = -1;
  function step(by) {
    const visible = sections.filter((section) => !section.hidden);
    if (visible.length === 0) return;
    at = Math.min(Math.max(at + by, 0), visible.length - 1);
    open(visible[at]);
    history.replaceState(null, '', '#' + encodeURI(visible[at].id));
  }
  document.addEventListener('keydown', (event) => {
    if (event.target === search) {
      if (event.key === 'Escape') { search.value = ''; filter(); search.blur(); }
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select')) return;
    if (event.key === 'n' || event.key === 'j') step(1);
    if (event.key === 'p' || event.key === 'k') step(-1);
    if (event.key === '/') { event.preventDefault(); search.focus(); }
  });

  // The part of its time that a timeline shows, in seconds: everything, unless somebody zooms.
  function endOf(svg) { return Number(svg.dataset.end); }
  function shownOf(section) { return section.shown || {from: 0, to: endOf(timelineOf(section))}; }
  function perSecond(section) {
    const svg = timelineOf(section), shown = shownOf(section);
    return endOf(svg) * Number(svg.dataset.perSecond) / (shown.to - shown.from);
  }
  function xAt(section, seconds) {
    return Number(timelineOf(section).dataset.left) + (seconds - shownOf(section).from) * perSecond(section);
  }
  function zoom(section, factor) {
    const svg = timelineOf(section), end = endOf(svg), now = shownOf(section);
    const span = Math.min(end, Math.max(0.05, (now.to - now.from) / factor));
    const at = section.cursor >= now.from && section.cursor <= now.to ? section.cursor : (now.from + now.to) / 2;
    const share = (at - now.from) / (now.to - now.from);
    const from = factor === 0 ? 0 : Math.min(Math.max(0, at - share * span), end - span);
    section.shown = {from: from, to: factor === 0 ? end : from + span};
    layOut(section);
  }
  function layOut(section) {
    const svg = timelineOf(section), {from, to} = shownOf(section);
    svg.querySelectorAll('rect[data-begin]').forEach((bar) => {
      const begin = Math.max(from, Number(bar.dataset.begin)), end = Math.min(to, Number(bar.dataset.end));
      bar.style.display = begin <= end ? '' : 'none';
      bar.setAttribute('x', xAt(section, begin));
      bar.setAttribute('width', Math.max(1.5, (end - begin) * perSecond(section)));
    });
    svg.querySelectorAll('path.hatch').forEach((each) => { each.style.display = to - from < endOf(svg) ? 'none' : ''; });
    const line = svg.querySelector('line.grid'), label = svg.querySelector('text.axis');
    let step = 1e-3;
    for (const factor of [2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2]) if ((to - from) / step > 12) step *= factor;
    svg.querySelectorAll('line.grid, text.axis').forEach((each) => each.remove());
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9; ++k) {
      const grid = line.cloneNode(), text = label.cloneNode();
      grid.setAttribute('x1', xAt(section, k * step));
      grid.setAttribute('x2', xAt(section, k * step));
      text.setAttribute('x', xAt(section, k * step));
      text.textContent = Number((k * step).toFixed(3));
      svg.prepend(grid, text);
    }
    mark(section, section.cursor || 0);
  }

  // One cursor per section, in seconds: a line across its timeline, and the time of its replay.
  function timelineOf(section) { return section.querySelector('svg.timeline[data-per-second]'); }
  function mark(section, seconds) {
    const svg = timelineOf(section);
    if (!svg) return;
    let line = svg.querySelector('line.cursor');
    if (!line) {
      line = document.createElementNS(svg.namespaceURI, 'line');
      line.setAttribute('class', 'cursor');
      line.setAttribute('y1', 0);
      line.setAttribute('y2', svg.viewBox.baseVal.height);
      svg.appendChild(line);
    }
    const x = xAt(section, seconds);
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
    line.setAttribute('visibility', x < Number(svg.dataset.left) - 0.01 || x > svg.viewBox.baseVal.width ? 'hidden' : 'visible');
    section.querySelector('output').textContent = seconds.toFixed(4) + ' s';
    tellBoundaries(section, seconds);
  }
  /// What began or ended where the cursor is, and which condition did it.
  function tellBoundaries(section, seconds) {
    const place = section.querySelector('.turned');
    if (!place) return;
    if (!section.boundaries) section.boundaries = JSON.parse(section.querySelector('script.boundaries').textContent);
    const lines = [];
    section.boundaries.forEach((each) => {
      if (Math.abs(each.begin - seconds) < 1e-4) lines.push(each.event + ' began: ' + each.began);
      if (Math.abs(each.end - seconds) < 1e-4) lines.push(each.event + ' ended: ' + each.ended);
    });
    const text = lines.join('\n');
    if (place.dataset.told === text) return;
    place.dataset.told = text;
    place.replaceChildren(...lines.map((line) => {
      const told = document.createElement('div');
      told.textContent = line;
      return told;
    }));
  }
  function setCursor(section, seconds) {
    if (section.player) return section.player.seek(seconds);  // which marks it
    section.cursor = seconds;
    mark(section, seconds);
  }
  function link(section) {
    return '#' + encodeURI(section.id) + '@' + (section.cursor || 0).toFixed(4) + 's';
  }
  sections.forEach((section) => {
    const svg = timelineOf(section);
    if (!svg) return;
    function moment(event) {
      const frame = svg.getBoundingClientRect();
      const x = (event.clientX - frame.left) * svg.viewBox.baseVal.width / frame.width;
      const seconds = shownOf(section).from + (x - Number(svg.dataset.left)) / perSecond(section);
      return Math.min(Math.max(0, seconds), endOf(svg));
    }
    svg.addEventListener('pointermove', (event) => { if (event.buttons > 0) setCursor(section, moment(event)); });
    svg.addEventListener('click', (event) => {
      const bar = event.target.closest('rect[data-begin]');
      const exact = bar ? nearest(moment(event), [Number(bar.dataset.begin), Number(bar.dataset.end)], section) : moment(event);
      setCursor(section, exact);
      history.replaceState(null, '', link(section));
    });
    const buttons = document.createElement('div');
    buttons.className = 'zoom';
    for (const [text, factor, key] of [['zoom in', 2, '+'], ['zoom out', 0.5, '-'], ['all', 0, '0']]) {
      const button = document.createElement('button');
      button.type = 'button';
      button.className = 'chip';
      button.textContent = text;
      button.title = 'key ' + key;
      button.addEventListener('click', () => zoom(section, factor));
      buttons.appendChild(button);
    }
    svg.parentNode.before(buttons);
    svg.parentNode.addEventListener('keydown', (event) => {
      const factor = {'+': 2, '=': 2, '-': 0.5, 0: 0}[event.key];
      if (factor !== undefined) {
        event.preventDefault();
        zoom(section, factor);
      }
      const by = {ArrowLeft: -1 / 60, ArrowRight: 1 / 60}[event.key];
      if (event.key === 'b' || event.key === 'B') {
        event.preventDefault();
        setCursor(section, boundary(svg, section.cursor || 0, event.key === 'b'));
        history.replaceState(null, '', link(section));
      }
      if (!by) return;
      event.preventDefault();
      setCursor(section, Math.min(Math.max(0, (section.cursor || 0) + by * (event.shiftKey ? 10 : 1)), endOf(svg)));
      history.replaceState(null, '', link(section));
    });
  });
  /// A click near the end of a bar means that end.
  function nearest(seconds, ends, section) {
    const near = 8 / perSecond(section);
    const end = ends.find((each) => Math.abs(each - seconds) <= near);
    return end === undefined ? seconds : end;
  }
  /// The next boundary of any event after this time, or the last before it.
  function boundary(svg, seconds, forward) {
    const all = [];
    svg.querySelectorAll('rect[data-begin]').forEach((bar) => all.push(Number(bar.dataset.begin), Number(bar.dataset.end)));
    const beyond = all.filter((each) => (forward ? each > seconds + 1e-6 : each < seconds - 1e-6));
    if (beyond.length === 0) return seconds;
    return forward ? Math.min(...beyond) : Math.max(...beyond);
  }

  // Pictures at a moment that differs: the difference of both, and one over the other with a slider.
  function tile(pair, caption, ...images) {
    const figure = document.createElement('figure'), stack = document.createElement('div'), text = document.createElement('figcaption');
    stack.className = 'stack';
    for (const image of images) {
      const copy = document.createElement('img');
      copy.src = image.src;
      copy.alt = '';
      stack.appendChild(copy);
    }
    text.textContent = caption;
    figure.append(stack, text);
    pair.appendChild(figure);
    return figure;
  }
  document.querySelectorAll('.drawn-difference').forEach((pair) => {
    const images = pair.querySelectorAll('img');
    if (images.length !== 2) return;
    tile(pair, 'difference', ...images).classList.add('blend');
    const over = tile(pair, 'golden left of the slider, recognised right of it', ...images);
    const slider = document.createElement('input');
    slider.type = 'range';
    slider.min = 0;
    slider.max = 100;
    slider.value = 50;
    slider.setAttribute('aria-label', 'share of the golden picture that is shown');
    const cut = () => { over.querySelector('img:last-child').style.clipPath = 'inset(0 0 0 ' + slider.value + '%)'; };
    slider.addEventListener('input', cut);
    over.insertBefore(slider, over.lastChild);
    cut();
  });

  // The 3D replay: its script and its data are deflated in the page and read when somebody wants them.
  async function inflated(base64) {
    const bytes = Uint8Array.from(atob(base64), (char) => char.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Response(stream).text();
  }
  async function loadPlayer() {
    if (window.prehendReplay) return;
    const script = document.createElement('script');
    script.textContent = await inflated(document.getElementById('replay-bundle').textContent);
    document.head.appendChild(script);
  }
  let playing = null;
  async function openReplay(section) {
    if (section.player) return section.player;
    const place = section.querySelector('.replay');
    if (!place) return null;
    await loadPlayer();
    const data = JSON.parse(await inflated(section.querySelector('script.replay-data').textContent));
    if (section.player) return section.player;
    if (playing) closeReplay(playing);
    const button = place.querySelector('button');
    const stage = document.createElement('div');
    place.appendChild(stage);
    try {
      const start = section.cursor || 0;
      section.player = window.prehendReplay.mount(stage, data, (seconds) => {
        section.cursor = seconds;
        mark(section, seconds);
      });
      playing = section;
      button.textContent = 'Close the 3D replay';
      button.setAttribute('aria-expanded', 'true');
      section.player.seek(start);
    } catch (error) {
      stage.textContent = 'This browser cannot show the 3D replay: ' + error.message;
    }
    return section.player;
  }
  function closeReplay(section) {
    section.player.remove();
    section.player = null;
    const place = section.querySelector('.replay');
    place.lastElementChild.remove();
    const button = place.querySelector('button');
    button.textContent = '3D replay';
    button.setAttribute('aria-expanded', 'false');
    if (playing === section) playing = null;
  }
  document.querySelectorAll('.replay').forEach((place) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'chip';
    button.textContent = '3D replay';
    button.setAttribute('aria-expanded', 'false');
    place.appendChild(button);
    const section = place.closest('section');
    button.addEventListener('click', () => (section.player ? closeReplay(section) : openReplay(section)));
  });

  function follow() {
    const parts = decodeURI(location.hash.slice(1)).split('@');
    const section = document.getElementById(parts[0]);
    if (!section || !section.matches('section.scenario')) return;
    at = sections.filter((each) => !each.hidden).indexOf(section);
    open(section);
    const seconds = parseFloat(parts[1]);
    if (!(seconds >= 0)) return;
    setCursor(section, seconds);
    openReplay(section);
  }
  window.addEventListener('hashchange', follow);
  window.addEventListener('beforeprint', () => {
    document.querySelectorAll('section.scenario:not([data-verdict=passed]):not([data-verdict=unchanged]) details')
      .forEach((each) => { each.open = true; });
  });

  function sectionOf(id) { return sections.find((section) => section.id === id); }
  window.prehendReport = {
    scenarios: () => sections.map((section) => section.id),
    setCursor: (id, seconds) => setCursor(sectionOf(id), seconds),
    cursorOf: (id) => sectionOf(id).cursor || 0,
    openReplay: (id) => openReplay(sectionOf(id)),
  };
  filter();
  follow();
}());

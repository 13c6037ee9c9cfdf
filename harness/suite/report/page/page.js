// SPDX-License-Identifier: Apache-2.0
// The script of the report page: filter, search, keyboard, links, one cursor across the rows of a timeline and the 3D
// replay. Without it everything can be read. What it offers to other scripts, window.prehendReport, is described in
// docs/report-page.md.
(function () {
  'use strict';
  const sections = Array.from(document.querySelectorAll('section.scenario'));
  const rows = Array.from(document.querySelectorAll('tr[data-of]'));
  const search = document.getElementById('search');
  const chips = Array.from(document.querySelectorAll('#tools button.chip'));
  const causes = Array.from(document.querySelectorAll('button.cause'));
  const shown = document.getElementById('shown');
  const groups = document.getElementById('groups');
  const wide = window.matchMedia('(min-width: 1100px)');
  document.getElementById('tools').hidden = false;
  document.documentElement.classList.add('panes');

  sections.forEach((section) => { section.row = rows.find((row) => row.dataset.of === section.id); });
  function textOf(section) {
    if (!section.searched) {
      const parts = Array.from(section.querySelectorAll('h2, div.soft, p, pre, text, title'));
      section.searched = parts.map((part) => part.textContent).join(' ').toLowerCase();
    }
    return section.searched;
  }
  const isPressed = (button) => button.getAttribute('aria-pressed') === 'true';
  function wanted(section) {
    const verdicts = chips.filter(isPressed), because = causes.filter(isPressed);
    if (verdicts.length > 0 && !verdicts.some((chip) => chip.dataset.verdict === section.dataset.verdict)) return false;
    const of = section.row.dataset.causes.split(' ');
    if (because.length > 0 && !because.some((cause) => of.includes(cause.dataset.cause))) return false;
    const words = search.value.toLowerCase().split(' ').filter(Boolean);
    return words.length === 0 || words.every((word) => textOf(section).includes(word));
  }
  function filter() {
    let count = 0;
    sections.forEach((section) => {
      const keep = wanted(section);
      section.hidden = section.row.hidden = !keep;
      if (keep) count += 1;
    });
    document.querySelectorAll('#list tr.group').forEach((head) => {
      let row = head.nextElementSibling;
      while (row && row.hidden && row.dataset.of) row = row.nextElementSibling;
      head.hidden = !row || !row.dataset.of;
    });
    shown.textContent = count + ' of ' + sections.length + ' shown';
    if (chosen ? chosen.hidden : wide.matches) choose(wide.matches ? inOrder()[0] : null);
  }
  /// Those that are shown, as the list has them.
  function inOrder() {
    return Array.from(document.querySelectorAll('tr[data-of]:not([hidden])'), (row) => document.getElementById(row.dataset.of));
  }
  function group() {
    document.querySelectorAll('#list tr.group').forEach((head) => head.remove());
    const wordOf = (verdict) => {
      const chip = chips.find((each) => each.dataset.verdict === verdict);
      return chip ? chip.textContent.replace(/ \d+$/, '') : verdict;
    };
    const of = {
      'by verdict': (row) => wordOf(row.dataset.verdict),
      'by folder': (row) => row.dataset.of.split('/').slice(0, -1).join('/') || 'no folder',
      'by cause': (row) => (row.dataset.causes ? 'cause ' + row.dataset.causes.split(' ')[0] : 'no failure'),
    }[groups.value];
    const sorted = new Map();
    rows.forEach((row) => sorted.set(of(row), [...(sorted.get(of(row)) || []), row]));
    const names = [...sorted.keys()];
    if (groups.value !== 'by verdict') names.sort((a, b) => a.localeCompare(b, 'en', {numeric: true}));
    names.forEach((name) => {
      const head = document.createElement('tr'), cell = document.createElement('th');
      head.className = 'group';
      cell.colSpan = 3;
      cell.textContent = name;
      head.append(cell);
      rows[0].parentNode.append(head, ...sorted.get(name));
    });
    filter();
  }
  search.addEventListener('input', filter);
  groups.addEventListener('change', group);
  [...chips, ...causes].forEach((chip) => chip.addEventListener('click', () => {
    chip.setAttribute('aria-pressed', String(!isPressed(chip)));
    filter();
  }));

  /// A timeline as small as a line of the list.
  sections.forEach((section) => {
    const link = section.row.querySelector('a'), title = section.querySelector('h2').lastChild;
    for (const name of [link.lastChild, title])
      name.replaceWith(...name.textContent.split(/(?<=[_/])/).flatMap((part) => [part, document.createElement('wbr')]));
    const svg = timelineOf(section);
    if (!svg) return;
    const {width, height} = svg.viewBox.baseVal, left = Number(svg.dataset.left);
    const small = document.createElementNS(svg.namespaceURI, 'svg');
    small.setAttribute('viewBox', left + ' 0 ' + (width - left) + ' ' + height);
    small.setAttribute('preserveAspectRatio', 'none');
    small.setAttribute('aria-hidden', 'true');
    svg.querySelectorAll('rect[data-begin]:not(.step), path.hatch').forEach((bar) => small.append(bar.cloneNode()));
    section.row.querySelector('.mini').append(small);
    const picture = section.querySelector('img');
    if (!picture) return;
    const thumb = picture.cloneNode();
    thumb.alt = '';
    section.row.prepend(thumb);
  });
  rows.forEach((row) => row.addEventListener('click', (event) => {
    if (!event.target.closest('a')) row.querySelector('a').click();
  }));

  // On a wide screen the chosen scenario stands beside the list; else all are below it.
  let chosen = null;
  function choose(section) {
    if (chosen === section) return;
    if (chosen) chosen.row.removeAttribute('aria-current');
    sections.forEach((each) => each.classList.toggle('chosen', each === section));
    chosen = section || null;
    if (!section) return;
    section.row.setAttribute('aria-current', 'true');
    if (!wide.matches) return;
    section.querySelector('details').open = true;
    const list = document.getElementById('list'), place = section.row.getBoundingClientRect(), pane = list.getBoundingClientRect();
    if (place.top < pane.top || place.bottom > pane.bottom) list.scrollTop += place.top - pane.top - pane.height / 3;
    openReplay(section);
  }
  function open(section) {
    choose(section);
    section.querySelector('details').open = true;
    section.querySelector('summary').focus({preventScroll: true});
    section.scrollIntoView({block: 'start'});
  }
  function step(by) {
    const visible = inOrder();
    if (visible.length === 0) return;
    open(visible[Math.min(Math.max(chosen ? visible.indexOf(chosen) + by : 0, 0), visible.length - 1)]);
    history.replaceState(null, '', '#' + encodeURI(chosen.id));
  }
  document.addEventListener('keydown', (event) => {
    if (event.target === search) {
      if (event.key === 'Escape') { search.value = ''; filter(); search.blur(); }
      if (event.key === 'Enter') step(-Infinity);
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select')) return;
    if (event.key === 'n' || event.key === 'j') step(1);
    if (event.key === 'p' || event.key === 'k') step(-1);
    if (event.key === '/') { event.preventDefault(); search.focus(); }
  });
  document.querySelectorAll('pre.command').forEach((pre) => {
    const copy = button('copy', 'chip copy', async () => {
      await navigator.clipboard.writeText(pre.textContent);
      copy.textContent = 'copied';
    });
    pre.after(copy);
  });

  // The part of its time that a timeline shows, in seconds: everything, unless somebody zooms.
  function endOf(svg) { return Number(svg.dataset.end); }
  function shownOf(section) { return section.shown || {from: 0, to: endOf(timelineOf(section))}; }
  /// As the program drew it, its plot ends so far from its right side.
  const kRight = 18;
  function perSecond(section) {
    const svg = timelineOf(section), shown = shownOf(section);
    return (svg.viewBox.baseVal.width - Number(svg.dataset.left) - kRight) / (shown.to - shown.from);
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
    const svg = timelineOf(section), {from, to} = shownOf(section), scale = perSecond(section);
    svg.querySelectorAll('[data-begin]').forEach((bar) => {
      const begin = Math.max(from, Number(bar.dataset.begin)), end = Math.min(to, Number(bar.dataset.end));
      bar.style.display = begin <= end ? '' : 'none';
      if (begin > end) return;
      if (bar.matches('.hatch')) return bar.setAttribute('d', hatched(bar, xAt(section, begin), Math.max(3, (end - begin) * scale)));
      if (bar.matches('.in_bar')) {  // as far as it fits
        bar.style.display = 7 * bar.textContent.length < (end - begin) * scale ? '' : 'none';
        return bar.setAttribute('x', xAt(section, (begin + end) / 2));
      }
      bar.setAttribute('x', xAt(section, begin));
      bar.setAttribute('width', Math.max(2.5, (end - begin) * scale));
    });
    const right = svg.viewBox.baseVal.width - kRight;
    svg.querySelector('line.base').setAttribute('x2', right);
    svg.querySelector('text.name').setAttribute('x', (Number(svg.dataset.left) + right) / 2);
    const line = svg.querySelector('line.grid'), label = svg.querySelector('text.axis');
    let step = 1e-3;
    for (const factor of [2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2, 2, 2.5, 2]) if ((to - from) / step > 12) step *= factor;
    svg.querySelectorAll('line.grid, text.axis').forEach((each) => each.remove());
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9; ++k) {
      const grid = line.cloneNode(), text = label.cloneNode();
      grid.setAttribute('x1', xAt(section, k * step));
      grid.setAttribute('x2', xAt(section, k * step));
      text.textContent = Number((k * step).toFixed(3));
      text.setAttribute('x', Math.min(xAt(section, k * step), svg.viewBox.baseVal.width - 3.6 * text.textContent.length));
      svg.prepend(grid, text);
    }
    mark(section, section.cursor || 0);
  }

  /// The slanted lines of a place that differs, in a frame, as the program draws them.
  function hatched(path, x, width) {
    if (!path.place) path.place = path.getAttribute('d').match(/^M[^,]*,([^h]*)h[^v]*v([^h]*)h/).slice(1).map(Number);
    const [top, tall] = path.place;
    let d = 'M' + x + ',' + top + 'h' + width + 'v' + tall + 'h' + -width + 'z';
    for (let from = x - tall + 5; from < x + width; from += 5) {
      const first = Math.max(from, x), last = Math.min(from + tall, x + width);
      d += 'M' + first + ',' + (top + tall - (first - from)) + 'L' + last + ',' + (top + tall - (last - from));
    }
    return d;
  }
  // As wide as there is room, so that its texts keep their size.
  const watcher = new ResizeObserver((entries) => entries.forEach(({target}) => {
    const svg = target.querySelector('svg.timeline'), width = svg.clientWidth, {height} = svg.viewBox.baseVal;
    if (width === 0 || width === svg.viewBox.baseVal.width) return;
    svg.setAttribute('viewBox', '0 0 ' + width + ' ' + height);
    layOut(target.closest('section'));
  }));

  // One cursor per section, in seconds: a line across its timeline and its signals, and the time of its replay.
  function timelineOf(section) { return section.querySelector('svg.timeline[data-per-second]'); }
  function cursorIn(svg, x) {
    let line = svg.querySelector('line.cursor');
    if (!line) {
      line = document.createElementNS(svg.namespaceURI, 'line');
      line.setAttribute('class', 'cursor');
      line.setAttribute('y1', 0);
      line.setAttribute('y2', svg.viewBox.baseVal.height);
      svg.appendChild(line);
    }
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
    line.setAttribute('visibility', x < Number(svg.dataset.left) - 0.01 || x > svg.viewBox.baseVal.width ? 'hidden' : 'visible');
  }
  function mark(section, seconds) {
    const svg = timelineOf(section);
    if (!svg) return;
    cursorIn(svg, xAt(section, seconds));
    section.querySelectorAll('svg.signal').forEach((signal) => {
      const {left, from, perSecond, end} = signal.dataset;
      cursorIn(signal, seconds > Number(end) ? -1 : Number(left) + (seconds - Number(from)) * Number(perSecond));
    });
    if (section.player) section.player.ghost(goldenAt(svg, seconds));
    if (section === chosen || seconds > 0) showFilm(section, seconds);
    section.querySelector('output').textContent = seconds.toFixed(4) + ' s';
    tellBoundaries(section, seconds);
  }
  /// The frame of the video that was there at this time of the episode.
  function showFilm(section, seconds) {
    const video = section.querySelector('video');
    if (!video || !video.paused) return;
    video.preload = 'auto';
    video.wanted = Math.max(0, seconds - Number(video.dataset.offset));
    if (!video.seeking) video.currentTime = video.wanted;
  }
  document.querySelectorAll('video').forEach((video) => {
    const section = video.closest('section');
    video.muted = true;
    video.addEventListener('seeked', () => {
      if (video.paused && Math.abs(video.currentTime - video.wanted) > 1e-3) video.currentTime = video.wanted;
    });
    const follow = () => {
      if (video.paused) return;
      setCursor(section, Math.max(0, video.currentTime + Number(video.dataset.offset)));
      requestAnimationFrame(follow);
    };
    video.addEventListener('play', () => requestAnimationFrame(follow));
  });
  /// In a hatched place, when the golden has the boundary that is elsewhere here; else null.
  function goldenAt(svg, seconds) {
    const times = Array.from(svg.querySelectorAll('rect.golden.differs'), (bar) => [bar.dataset.begin, bar.dataset.end]).flat();
    for (const {dataset: {begin, end}} of svg.querySelectorAll('path.hatch'))
      if (Number(begin) <= seconds && seconds <= Number(end) && times.includes(begin) !== times.includes(end))
        return Number(times.includes(begin) ? begin : end);
    return null;
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
      const beside = Array.from(svg.querySelectorAll('rect[data-begin]')).filter((bar) => {
        const {top, bottom} = bar.getBoundingClientRect();
        return top <= event.clientY && event.clientY < bottom;
      });
      setCursor(section, nearest(moment(event), beside.flatMap(({dataset: {begin, end}}) => [Number(begin), Number(end)]), section));
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
    watcher.observe(svg.parentNode);
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
  /// A click near an end of a bar, in it or beside it, means that end.
  function nearest(seconds, ends, section) {
    const apart = (end) => Math.abs(end - seconds), near = 8 / perSecond(section);
    return ends.filter((end) => apart(end) <= near).sort((a, b) => apart(a) - apart(b)).concat(seconds)[0];
  }
  /// The next boundary of any event after this time, or the last before it.
  function boundary(svg, seconds, forward) {
    const all = [];
    svg.querySelectorAll('rect[data-begin]:not(.step)').forEach((bar) => all.push(Number(bar.dataset.begin), Number(bar.dataset.end)));
    const beyond = all.filter((each) => (forward ? each > seconds + 1e-6 : each < seconds - 1e-6));
    if (beyond.length === 0) return seconds;
    return forward ? Math.min(...beyond) : Math.max(...beyond);
  }

  function button(text, style, pressed) {
    const made = document.createElement('button');
    made.type = 'button';
    made.className = style;
    made.textContent = text;
    made.addEventListener('click', pressed);
    return made;
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
  let bundle = null;
  function loadPlayer() {
    bundle = bundle || inflated(document.getElementById('replay-bundle').textContent).then((text) => {
      const script = document.createElement('script');
      script.textContent = text;
      document.head.appendChild(script);
    });
    return bundle;
  }
  let playing = null;
  async function openReplay(section) {
    if (section.player) return section.player;
    const place = section.querySelector('.replay');
    if (!place) return null;
    await loadPlayer();
    const data = JSON.parse(await inflated(section.querySelector('script.replay-data').textContent));
    if (section.player) return section.player;
    if (wide.matches && section !== chosen) return null;  // another one was chosen meanwhile
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
    const section = place.closest('section');
    const open = button('3D replay', 'chip', () => (section.player ? closeReplay(section) : openReplay(section)));
    open.setAttribute('aria-expanded', 'false');
    place.appendChild(open);
  });

  function follow() {
    const parts = decodeURI(location.hash.slice(1)).split('@');
    const section = document.getElementById(parts[0]);
    if (!section || !section.matches('section.scenario')) return;
    open(section);
    const seconds = parseFloat(parts[1]);
    if (!(seconds >= 0)) return;
    setCursor(section, seconds);
    openReplay(section);
  }
  window.addEventListener('hashchange', follow);
  // Printed are the causes and the list; with a search or a filter, what is shown, in full.
  window.addEventListener('beforeprint', () => {
    const some = inOrder();
    document.documentElement.classList.toggle('full', some.length < sections.length || sections.length === 1);
    some.forEach((section) => section.querySelectorAll('details').forEach((each) => { each.open = true; }));
  });

  function sectionOf(id) {
    const found = sections.find((section) => section.id === id);
    if (!found) throw new Error("no scenario is called '" + id + "'; scenarios() lists them");
    return found;
  }
  window.prehendReport = {
    scenarios: () => sections.map((section) => section.id),
    setCursor: (id, seconds) => setCursor(sectionOf(id), seconds),
    cursorOf: (id) => sectionOf(id).cursor || 0,
    openReplay: (id) => {
      choose(sectionOf(id));
      return openReplay(sectionOf(id));
    },
    // For sides.js.
    page: {sections, sectionOf, timelineOf, button, inOrder, setCursor, show: (section) => {
      if (chosen !== section) open(section);
      history.replaceState(null, '', link(section));
    }},
  };
  group();
  follow();
}());

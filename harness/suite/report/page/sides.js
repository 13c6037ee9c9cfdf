// SPDX-License-Identifier: Apache-2.0
// The script of the report page, after page.js: what several sides say, and the last runs.
(function () {
  'use strict';
  const {sections, sectionOf, timelineOf, button, inOrder, setCursor, show} = window.prehendReport.page;

  // Labels, grammars and others beside each other: at each time of an event at which one of them says something else, one
  // side can be accepted. What is saved are all labels, with these changes, in the clock of the episode.
  const sides = Array.from((document.querySelector('p.sides') || document.createElement('p')).children, (each) => each.textContent);
  let difference = null;  // the one that keys are about
  /// Times of events in which sides overlap; made when somebody looks.
  function spansOf(section) {
    if (section.spans) return section.spans;
    const svg = timelineOf(section), events = new Map();
    section.spans = [];
    if (!svg) return section.spans;
    svg.querySelectorAll('rect[data-event]').forEach((bar) => {
      const of = bar.dataset.event;
      events.set(of, [...(events.get(of) || []), bar]);
    });
    events.forEach((bars, event) => {
      let span = null;
      bars.sort((a, b) => a.dataset.begin - b.dataset.begin).forEach((bar) => {
        const begin = Number(bar.dataset.begin), end = Number(bar.dataset.end);
        if (!span || begin >= span.end) {
          span = {section, event, begin, end, says: sides.map(() => []), differs: false, side: 0, decided: false};
          section.spans.push(span);
        }
        span.end = Math.max(span.end, end);
        span.says[Number(bar.dataset.lane)].push([begin, end]);
        span.differs = span.differs || bar.matches('.differs');
      });
    });
    section.spans.sort((a, b) => a.begin - b.begin);
    recall(section, section.spans);
    return section.spans;
  }
  const differencesOf = (section) => spansOf(section).filter((span) => span.differs);
  function list(section) {
    if (section.save || differencesOf(section).length === 0) return;
    const all = document.createElement('ol');
    all.className = 'choices';
    differencesOf(section).forEach((span) => {
      span.item = document.createElement('li');
      const name = button(span.event.replace(/\w+=/g, ''), 'plain', () => go(span));
      span.buttons = span.says.map((said, k) => {
        const times = said.map(([begin, end]) => begin.toFixed(2) + '\u2013' + end.toFixed(2) + ' s').join(', ');
        const made = button((k + 1) + ': ' + (times || 'nothing'), 'chip', () => { go(span); accept(span, k); });
        made.title = sides[k];
        return made;
      });
      span.item.append(name, ...span.buttons);
      all.append(span.item);
    });
    section.save = button('save as labels', 'chip', () => {
      const link = document.createElement('a');
      link.href = URL.createObjectURL(new Blob([labelsOf(section)], {type: 'text/csv'}));
      link.download = section.id.split('/').pop() + '.csv';
      link.click();
    });
    section.querySelector('.time').append(all, section.save);
    showDecisions(section);
  }
  const seen = new IntersectionObserver((entries) => entries.forEach((entry) => { if (entry.isIntersecting) list(entry.target.closest('section')); }));
  if (sides.length > 0) document.querySelectorAll('section .time').forEach((time) => seen.observe(time));
  function go(span) {
    if (difference) difference.item.removeAttribute('aria-current');
    difference = span;
    list(span.section);
    span.item.setAttribute('aria-current', 'true');
    span.item.scrollIntoView({block: 'nearest'});
    setCursor(span.section, span.begin);
    show(span.section);
  }
  function stepDifference(by) {
    const all = sides.length === 0 ? [] : inOrder().flatMap(differencesOf);
    if (all.length === 0) return;
    const at = difference ? all.indexOf(difference) + by : all.findIndex((span) => span.section.row.matches('[aria-current]'));
    go(all[Math.min(Math.max(at, 0), all.length - 1)]);
  }
  function accept(span, side) {
    span.side = side;
    span.decided = true;
    showDecisions(span.section);
    keep(span.section);
  }
  function showDecisions(section) {
    differencesOf(section).forEach((span) => span.buttons.forEach((each, k) => each.setAttribute('aria-pressed', String(span.decided && k === span.side))));
    const changed = spansOf(section).filter((each) => each.side > 0).length;
    section.save.textContent = 'save as labels' + (changed === 0 ? '' : ', ' + (changed === 1 ? '1 change' : changed + ' changes'));
  }
  // Decisions stay when the page is opened again, also one that was made anew of the same labels and events.
  const keyOf = (section) => {
    let hash = 0x811c9dc5;
    const text = JSON.stringify([sides, spansOf(section).map((span) => [span.event, span.says, span.differs])]);
    for (let i = 0; i < text.length; ++i) hash = Math.imul(hash ^ text.charCodeAt(i), 0x01000193) >>> 0;
    return 'prehend ' + section.id + ' ' + hash.toString(16);
  };
  function keep(section) {
    const decided = differencesOf(section).map((span) => (span.decided ? span.side : null));
    try { localStorage.setItem(keyOf(section), JSON.stringify(decided)); } catch { /* a browser that keeps nothing */ }
  }
  function recall(section, spans) {
    let decided = null;
    try { decided = JSON.parse(localStorage.getItem(keyOf(section))); } catch { /* nor gives anything */ }
    spans.filter((span) => span.differs).forEach((span, i) => {
      const side = decided && decided[i];
      if (Number.isInteger(side) && side >= 0 && side < sides.length) Object.assign(span, {side, decided: true});
    });
  }
  function labelsOf(section) {
    const rows = spansOf(section).flatMap((span) => span.says[span.side].map(([begin, end]) => [begin, end, '"' + span.event + '"']));
    section.querySelectorAll('.moments span').forEach((each) => rows.push([each.dataset.at, each.dataset.at, '"' + each.dataset.event + '"']));
    // Of an event that is not there, a row without times says that it was looked for.
    const there = new Set(rows.map((row) => row[2]));
    const none = [...new Set(spansOf(section).map((span) => '"' + span.event + '"'))].filter((event) => !there.has(event) && event.includes('('));
    return ['begin_s,end_s,label', ...rows.sort((a, b) => a[0] - b[0]).map((row) => row.join()), ...none.map((event) => ',,' + event)].join('\n') + '\n';
  }

  // The last runs of a scenario: a bar for each, as high as it took long, with the colour of its verdict.
  const past = document.getElementById('history'), pastRuns = past && JSON.parse(past.textContent);
  sections.forEach((section) => {
    const runs = (pastRuns && pastRuns.of[section.id]) || [];
    if (runs.length < 2) return;
    const line = document.createElement('p'), longest = Math.max(...runs.map((run) => run[2]), 1e-3);
    line.className = 'soft history';
    runs.forEach(([of, verdict, seconds, margin]) => {
      const bar = document.createElement('span');
      bar.className = verdict;
      bar.style.height = (0.25 + seconds / longest) + 'em';
      bar.title = pastRuns.runs[of] + ': ' + verdict + ', ' + seconds.toFixed(2) + ' s' + (margin === null ? '' : ', ' + margin + ' ms of tolerance left');
      line.append(bar);
    });
    const failed = runs.filter((run) => run[1] !== 'passed').length, margins = runs.map((run) => run[3]).filter((each) => each !== null);
    line.append(' ' + (runs.length - failed) + ' of the last ' + runs.length + ' runs passed, in ' + Math.min(...runs.map((run) => run[2])).toFixed(2) + ' to ' +
      longest.toFixed(2) + ' s' + (margins.length === 0 ? '' : '; ' + margins[0] + ' ms of tolerance left then, ' + margins[margins.length - 1] + ' ms now'));
    section.querySelector('.views').before(line);
  });
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches('input, select')) return;
    if (event.key === 'd' || event.key === 'D') stepDifference(event.key === 'd' ? 1 : -1);
    if (difference && Number(event.key) >= 1 && Number(event.key) <= sides.length) accept(difference, Number(event.key) - 1);
  });
  window.prehendReport.labelsOf = (id) => labelsOf(sectionOf(id));
}());

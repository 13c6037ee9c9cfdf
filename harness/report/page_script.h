// SPDX-License-Identifier: Apache-2.0
// The script of the report page: filter, search, keyboard, links, a cursor across the rows of a
// timeline. Without it everything can be read. Tested by tests/harness/report/report_test.cc
#pragma once

#include <string_view>

namespace prehend::harness {

// Without the characters <, > and &, which HTML would not unescape here.
inline constexpr std::string_view kPageScript = R"(
(function () {
  'use strict';
  var sections = Array.from(document.querySelectorAll('section.scenario'));
  var search = document.getElementById('search');
  var chips = Array.from(document.querySelectorAll('button.chip'));
  var shown = document.getElementById('shown');
  document.getElementById('tools').hidden = false;
  function rowOf(section) { return document.querySelector('tr[data-of="' + CSS.escape(section.id) + '"]'); }
  function wanted(section) {
    var words = search.value.toLowerCase().split(' ').filter(Boolean);
    var pressed = chips.filter(function (chip) { return chip.getAttribute('aria-pressed') === 'true'; });
    var fits = pressed.length === 0 || pressed.some(function (chip) {
      return chip.dataset.verdict === section.dataset.verdict; });
    if (!fits) return false;
    var text = section.textContent.toLowerCase();
    return words.every(function (word) { return text.includes(word); });
  }
  function filter() {
    var count = 0;
    sections.forEach(function (section) {
      var keep = wanted(section);
      section.hidden = !keep;
      var row = rowOf(section);
      if (row) row.hidden = !keep;
      if (keep) count += 1;
    });
    shown.textContent = count + ' of ' + sections.length + ' shown';
  }
  search.addEventListener('input', filter);
  chips.forEach(function (chip) {
    chip.addEventListener('click', function () {
      chip.setAttribute('aria-pressed', String(chip.getAttribute('aria-pressed') !== 'true'));
      filter();
    });
  });
  function open(section) {
    section.querySelector('details').open = true;
    section.querySelector('summary').focus({preventScroll: true});
    section.scrollIntoView({block: 'start'});
  }
  var at = -1;
  function step(by) {
    var visible = sections.filter(function (section) { return !section.hidden; });
    if (visible.length === 0) return;
    at = Math.min(Math.max(at + by, 0), visible.length - 1);
    open(visible[at]);
    history.replaceState(null, '', '#' + encodeURI(visible[at].id));
  }
  document.addEventListener('keydown', function (event) {
    if (event.target === search) {
      if (event.key === 'Escape') { search.value = ''; filter(); search.blur(); }
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'n' || event.key === 'j') step(1);
    if (event.key === 'p' || event.key === 'k') step(-1);
    if (event.key === '/') { event.preventDefault(); search.focus(); }
  });
  function mark(svg, seconds) {
    var box = svg.viewBox.baseVal;
    var line = svg.querySelector('line.cursor');
    if (!line) {
      line = document.createElementNS(svg.namespaceURI, 'line');
      line.setAttribute('class', 'cursor');
      line.setAttribute('y1', 0);
      line.setAttribute('y2', box.height);
      svg.appendChild(line);
    }
    var x = Number(svg.dataset.left) + seconds * Number(svg.dataset.perSecond);
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
    svg.parentNode.querySelector('output').textContent = seconds.toFixed(4) + ' s';
  }
  document.querySelectorAll('svg.timeline').forEach(function (svg) {
    if (!svg.dataset.perSecond) return;
    function moment(event) {
      var frame = svg.getBoundingClientRect();
      var x = (event.clientX - frame.left) * svg.viewBox.baseVal.width / frame.width;
      return Math.max(0, (x - Number(svg.dataset.left)) / Number(svg.dataset.perSecond));
    }
    svg.addEventListener('pointermove', function (event) { mark(svg, moment(event)); });
    svg.addEventListener('click', function (event) {
      var id = svg.closest('section').id;
      history.replaceState(null, '', '#' + encodeURI(id) + '@' + moment(event).toFixed(4) + 's');
    });
  });
  function follow() {
    var parts = decodeURI(location.hash.slice(1)).split('@');
    var section = document.getElementById(parts[0]);
    if (!section || !section.matches('section.scenario')) return;
    at = sections.filter(function (each) { return !each.hidden; }).indexOf(section);
    open(section);
    var svg = section.querySelector('svg.timeline');
    if (svg) if (parts[1]) mark(svg, parseFloat(parts[1]));
  }
  window.addEventListener('hashchange', follow);
  window.addEventListener('beforeprint', function () {
    document.querySelectorAll('details').forEach(function (each) { each.open = true; });
  });
  filter();
  follow();
}());
)";

}  // namespace prehend::harness

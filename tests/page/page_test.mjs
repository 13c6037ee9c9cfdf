// SPDX-License-Identifier: Apache-2.0
// The report page in Chromium, as somebody uses it. Started by tests/page/run.
import {strict as assert} from 'node:assert';
import {readFileSync, statSync} from 'node:fs';
import {before, test} from 'node:test';
import {openPage, prehend, serious} from './browser.mjs';

const {SUITE_PAGE} = process.env;
const FAILS = 'pick_and_place/milk_carton_wrap', BODY = 'body/arm_follows_the_hand';
const CHANGED = ['--set', 'reach_radius=20cm'];
const FILE = process.cwd() + '/page/index.html';
const opened = (options) => openPage({file: FILE, ...options});
/// Of the page itself: what the driver says of its address may be a moment old.
const hashOf = (page) => page.evaluate(() => decodeURI(location.hash));

/// Pose of an entity at a tick, as the program records it for other grammars: what moved since.
function recordedPose(name, tick) {
  let pose = null;
  for (const line of prehend('run', FAILS, ...CHANGED, '--record', '-').split('\n')) {
    const frame = line ? JSON.parse(line) : {};
    if (!frame.samples || frame.tick > tick) continue;
    if (frame.samples[name]) pose = frame.samples[name].at_m;
  }
  return pose;
}

let hasReplay;
before(async () => {
  prehend('check', FAILS, BODY, 'slide/*', 'support/*', ...CHANGED, '--replay', 'all', '--report', process.cwd() + '/page');
  hasReplay = readFileSync(FILE, 'utf8').includes('id="replay-bundle"');
  if (!hasReplay) console.error('\nSKIPPED: the 3D replay in a browser: this build has none\n');
});

test('asks for nothing but itself and complains of nothing', async () => {
  const {page, seen, close} = await opened();
  if (hasReplay) {
    await page.evaluate((id) => window.prehendReport.openReplay(id), FAILS);
    await page.evaluate((id) => window.prehendReport.openReplay(id), BODY);
  }
  assert.deepEqual(seen, {requests: ['file://' + FILE], complaints: []});
  await close();
});

test('what failed is the first section', async () => {
  const {page, close} = await opened();
  const first = await page.evaluate(() => document.querySelector('section').dataset.verdict);
  assert.equal(first, 'failed');
  const verdicts = await page.evaluate(() => Array.from(document.querySelectorAll('section'), (each) => each.dataset.verdict));
  assert.ok(verdicts.includes('passed'), 'some pass, else this shows nothing');
  await close();
});

test('scrubbing to the begin of an event puts the thing where it was', async (context) => {
  if (!hasReplay) return context.skip('this build has no replay');
  const {events} = JSON.parse(prehend('run', FAILS, ...CHANGED, '--json'));
  const {page, close} = await opened();
  for (const wanted of ['picking_up', 'transporting', 'putting_down']) {
    const event = events.find((each) => each.event === wanted);
    for (const name of ['milk', 'right_hand']) {
      const drawn = await page.evaluate(async ([id, seconds, what]) => {
        const player = await window.prehendReport.openReplay(id);
        const scrubber = document.getElementById(id).querySelector('.replay input[type=range]');
        scrubber.value = String(seconds);
        scrubber.dispatchEvent(new Event('input'));
        return player.poseOf(what).p;
      }, [FAILS, event.begin_s, name]);
      const true_m = recordedPose(name, event.begin_tick);
      const off_mm = 1000 * Math.hypot(...drawn.map((value, i) => value - true_m[i]));
      assert.ok(off_mm < 1, `${name} at ${wanted}.begin is ${off_mm.toFixed(3)} mm off`);
    }
  }
  const cursor = await page.evaluate((id) => document.getElementById(id).querySelector('output').textContent, FAILS);
  assert.equal(cursor, events.find((each) => each.event === 'putting_down').begin_s.toFixed(4) + ' s', 'one cursor');
  await close();
});

test('a link opens a scenario at a moment', async () => {
  const {page, close} = await opened({hash: '#' + FAILS + '@1.2500s'});
  assert.equal(await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS), 1.25);
  if (hasReplay) {
    await page.waitForSelector('.replay canvas');
    assert.match(await page.textContent('.replay .clock'), /^1\.250 of/);
  }
  await close();
});

test('a click on a boundary says which condition turned there', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const section = page.locator('section[id="' + FAILS + '"]');
  const bar = section.locator('rect.actual').filter({has: page.locator('title', {hasText: 'picking_up'})});
  const box = await bar.evaluate((each) => {
    each.scrollIntoView({block: 'center'});
    const {left, top, height} = each.getBoundingClientRect();
    return {x: left + 2, y: top + height / 2};
  });
  await page.mouse.click(box.x, box.y);
  const told = await section.locator('.turned').textContent();
  assert.match(told, /picking_up\(right_hand, milk\) began: \S/);
  assert.match(told, /supported_by\(milk, table\) ended: \S/);
  await close();
});

test('a click in a short bar, or just beside it, means the nearer end', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const bar = page.locator('section[id="' + FAILS + '"] rect.actual').filter({has: page.locator('title', {hasText: 'picking_up'})});
  const {left, right, y, begin, end} = await bar.evaluate((each) => {
    each.scrollIntoView({block: 'center'});
    const {left, right, top, height} = each.getBoundingClientRect();
    return {left, right, y: top + height / 2, begin: Number(each.dataset.begin), end: Number(each.dataset.end)};
  });
  assert.ok(right - left > 9 && right - left < 13, `${right - left} px: of 8 both ends are near`);
  for (const [x, wanted] of [[left + 5, begin], [right - 4, end], [left - 6, begin], [right + 6, end]]) {
    await page.mouse.click(x, y);
    assert.equal(await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS), wanted, `${x - left} px after its begin`);
  }
  await page.mouse.click(right + 12, y);
  assert.ok(await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS) > end, 'farther away it is no end');
  await close();
});

test('the moment that differs is shown as golden, recognised, difference, and with a slider', async (context) => {
  const {page, seen, close} = await opened({hash: '#' + FAILS});
  const all = page.locator('section[id="' + FAILS + '"] .drawn-difference'), pair = all.first();
  if (await all.count() === 0) return context.skip('this build draws no pictures');
  assert.match(await pair.locator('p').textContent(), /begin of (reaching|pick_and_place)\(right_hand, milk\)/);
  const captions = await pair.locator('figcaption').allTextContents();
  assert.deepEqual(captions.map((each) => each.split(/[: ]/)[0]), ['golden', 'recognised', 'difference', 'golden']);
  const [golden, recognised] = await pair.locator('img').evaluateAll((images) => images.map((image) => image.src));
  assert.notEqual(golden, recognised);
  await pair.getByRole('slider').fill('80');
  assert.equal(await pair.locator('img').last().evaluate((image) => image.style.clipPath), 'inset(0px 0px 0px 80%)');
  assert.deepEqual(seen.complaints, []);
  await close();
});

test('each signal says what it was where the golden has the boundary', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const signal = page.locator('section[id="' + FAILS + '"] svg.signal').first();
  assert.equal(await signal.locator('line.golden').count(), 1);
  assert.match(await signal.textContent(), /golden: 0\.\d+ m/);
  await close();
});

test('zooming keeps the cursor where it is', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const section = page.locator('section[id="' + FAILS + '"]');
  await page.evaluate((id) => window.prehendReport.setCursor(id, 1.5), FAILS);
  const bar = section.locator('rect.actual').filter({has: page.locator('title', {hasText: 'picking_up'})});
  const x = () => section.locator('svg.timeline line.cursor').evaluate((line) => Number(line.getAttribute('x1')));
  const width = () => bar.evaluate((each) => Number(each.getAttribute('width')));
  const [x_before, width_before] = [await x(), await width()];
  await section.locator('.scroll').focus();
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  assert.ok(Math.abs(await x() - x_before) < 0.5, 'the cursor moved');
  assert.ok(Math.abs(await width() - 4 * width_before) < 0.5, `${await width()} of ${width_before}`);
  const box = await bar.evaluate((each) => {
    const {left, top, height} = each.getBoundingClientRect();
    return {x: left + 2, y: top + height / 2};
  });
  await page.mouse.click(box.x, box.y);
  assert.match(await section.locator('.turned').textContent(), /picking_up\(right_hand, milk\) began/);
  await page.keyboard.press('0');
  assert.ok(Math.abs(await width() - width_before) < 0.01);
  await close();
});

test('hatches go with the bars that they belong to', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const section = page.locator('section[id="' + FAILS + '"]');
  await page.evaluate((id) => window.prehendReport.setCursor(id, 0.1), FAILS);
  const places = () => section.locator('svg.timeline').evaluate((svg) => {
    const side = (each, which) => each.getBoundingClientRect()[which];
    const golden = svg.querySelector('rect.golden.differs');
    const hatch = Array.from(svg.querySelectorAll('path.hatch')).find((each) => each.dataset.begin === golden.dataset.begin);
    return {golden: side(golden, 'left'), hatch: side(hatch, 'left'), width: side(hatch, 'width'), shown: hatch.style.display};
  });
  const whole = await places();
  await section.locator('.scroll').focus();
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  const near = await places();
  for (const each of [whole, near]) assert.ok(Math.abs(each.golden - each.hatch) < 2, JSON.stringify(each));
  assert.equal(near.shown, '');
  assert.ok(Math.abs(near.width - 4 * whole.width) < 4, `${near.width} of ${whole.width}`);
  await close();
});

test('timeline, signal and replay are seen at once and have one cursor', async (context) => {
  if (!hasReplay) return context.skip('this build has no replay');
  const {page, close} = await opened({hash: '#' + FAILS + '@0.3000s'});
  const section = page.locator('section[id="' + FAILS + '"]');
  await section.locator('.replay canvas').waitFor();
  const at = (selector) => section.locator(selector).first().evaluate((svg) => {
    const {left, from, perSecond, end} = svg.dataset, width = svg.viewBox.baseVal.width;
    const scale = svg.matches('.timeline') ? (width - left - 18) / end : Number(perSecond);
    return Number(from) + (Number(svg.querySelector('line.cursor').getAttribute('x1')) - left) / scale;
  });
  assert.ok(Math.abs(await at('svg.timeline') - 0.3) < 1e-3);
  assert.ok(Math.abs(await at('svg.signal') - 0.3) < 1e-3);
  assert.match(await section.locator('.replay .clock').textContent(), /^0\.300 of/);
  const [timeline, replay] = [await section.locator('svg.timeline').boundingBox(), await section.locator('canvas').boundingBox()];
  assert.ok(replay.x >= timeline.x + timeline.width, 'side by side');
  assert.ok(replay.y < timeline.y + timeline.height && timeline.y < replay.y + replay.height, 'at one height');
  await close();
});

test('where the golden has a boundary elsewhere, it is shown as a ghost', async (context) => {
  if (!hasReplay) return context.skip('this build has no replay');
  const {page, close} = await opened();
  const ghost = await page.evaluate(async (id) => {
    const player = await window.prehendReport.openReplay(id);
    const seen = [];
    for (const seconds of [0.1, 3]) {
      player.seek(seconds);
      seen.push(Boolean(player.world.ghosts && player.world.ghosts.visible));
    }
    return seen;
  }, FAILS);
  assert.deepEqual(ghost, [true, false]);
  await close();
});

test('the replay holds all heads and paths, and no name covers what is named', async (context) => {
  if (!hasReplay) return context.skip('this build has no replay');
  const {page, close} = await opened();
  for (const view of ['fitted', 'front', 'side', 'top']) {
    const out = await page.evaluate(async ([id, name]) => {
      const player = await window.prehendReport.openReplay(id);
      player.view(name);
      player.camera.updateMatrixWorld();
      return player.world.seen.filter((point) => {
        const at = point.clone().project(player.camera);
        return Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || at.z > 1;
      }).length;
    }, [BODY, view]);
    assert.equal(out, 0, view);
  }
  const {labels, covered} = await page.evaluate(async (id) => {
    const player = await window.prehendReport.openReplay(id);
    player.view('fitted');
    player.render();
    const stage = player.stage.getBoundingClientRect(), boxes = player.labels.filter((one) => one.isIn).map((one) => one.label.getBoundingClientRect());
    const isIn = (box, {x, y}) => stage.left + x > box.left && stage.left + x < box.right && stage.top + y > box.top && stage.top + y < box.bottom;
    return {labels: boxes.length, covered: player.labels.filter((one) => one.isIn && boxes.some((box) => isIn(box, one.there))).length};
  }, BODY);
  assert.ok(labels >= 2, String(labels));
  assert.equal(covered, 0);
  await close();
});

test('causes and groups sort the list, Enter jumps to what is found', async () => {
  const {page, close} = await opened();
  const shown = () => page.locator('tr[data-of]:visible').count();
  const failed = await page.locator('tr[data-verdict=failed]').count(), all = await shown();
  assert.ok(failed < all);
  const causes = page.locator('button.cause');
  let caused = 0;
  for (let i = 0; i < await causes.count(); ++i) {
    await causes.nth(i).click();
    assert.match(await causes.nth(i).textContent(), new RegExp('^' + await shown() + ' scenarios?$'));
    caused += await shown();
    await causes.nth(i).click();
  }
  assert.equal(caused, failed, 'each failed scenario has one cause');
  assert.equal(await shown(), all);
  await page.locator('#groups').selectOption('by folder');
  assert.deepEqual((await page.locator('tr.group').allTextContents()), ['body', 'pick_and_place', 'slide', 'support']);
  await page.keyboard.press('Escape');
  await page.locator('#search').fill('arm_follows');
  await page.locator('#search').press('Enter');
  assert.equal(await hashOf(page), '#' + BODY);
  assert.equal(await page.locator('main > section:visible').count(), 1);
  await close();
});

test('each difference is explained, with the signal that decided', async () => {
  const {page, close} = await opened({hash: '#' + FAILS});
  const why = page.locator('section[id="' + FAILS + '"] details.difference');
  assert.equal(await why.count(), 2);
  assert.match(await why.first().textContent(), /Why: shifted reaching\(right_hand, milk\)/);
  assert.match(await why.first().locator('svg.signal').first().getAttribute('aria-label'), /in_sphere.*within 200 mm/);
  assert.ok(await why.first().locator('svg.signal').first().isVisible());
  await close();
});

test('by keyboard: search, next, boundaries, play', async () => {
  const {page, close} = await opened();
  const chosen = () => page.locator('main > section:visible').getAttribute('id');
  const listed = await page.locator('tr[data-of]').evaluateAll((rows) => rows.map((row) => row.dataset.of));
  assert.equal(await chosen(), listed[0]);
  await page.keyboard.press('n');
  assert.equal(await hashOf(page), '#' + listed[1], 'the next after that which is shown');
  await page.keyboard.press('p');
  await page.keyboard.press('/');
  await page.keyboard.type('slidq');
  assert.equal(await page.locator('main > section:visible').count(), 0);
  await page.keyboard.press('Backspace');
  assert.match(await chosen(), /slid/, 'the first found');
  await page.locator('#search').fill('');
  await page.keyboard.type('milk_carton_wrap');
  assert.equal(await page.textContent('#shown'), '1 of ' + await page.locator('section.scenario').count() + ' shown');
  const timeline = page.locator('section:visible .scroll');
  await timeline.focus();
  await page.keyboard.press('b');
  const first = await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS);
  await page.keyboard.press('b');
  assert.ok(await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS) > first);
  assert.match(await hashOf(page), /@0\.\d{4}s$/);
  if (hasReplay) {
    await page.waitForSelector('section:visible .replay canvas');
    await page.locator('.replay canvas').focus();
    await page.keyboard.press('.');
    const moved = await page.evaluate((id) => window.prehendReport.cursorOf(id), FAILS);
    await page.keyboard.press(' ');
    await page.waitForFunction(([id, from]) => window.prehendReport.cursorOf(id) > from + 0.05, [FAILS, moved]);
    await page.keyboard.press(' ');
    assert.equal(await page.textContent('.replay .play'), 'play', 'it pauses');
  }
  await close();
});

test('layers and views change the picture', async (context) => {
  if (!hasReplay) return context.skip('this build has no replay');
  const {page, close} = await opened();
  await page.evaluate((id) => window.prehendReport.openReplay(id).then((player) => player.seek(2)), BODY);
  const picture = () => page.evaluate(async () => {
    for (let frame = 0; frame < 2; ++frame) await new Promise(requestAnimationFrame);
    return document.querySelector('.replay canvas').toDataURL();
  });
  for (const layer of ['contacts', 'paths', 'gaze', 'body']) {
    const shown = await picture();
    await page.getByLabel(layer, {exact: true}).uncheck();
    assert.notEqual(await picture(), shown, layer);
  }
  const views = await page.locator('.replay select[aria-label=camera] option').allTextContents();
  assert.deepEqual(views, ['fitted', 'front', 'side', 'top', 'hand', 'eyes']);
  const pictures = new Set();
  for (const view of views) {
    await page.getByLabel('camera').selectOption(view);
    pictures.add(await picture());
  }
  assert.equal(pictures.size, views.length);
  await close();
});

for (const [where, options] of Object.entries({
  'on a desktop': {}, 'in the dark': {colorScheme: 'dark'}, 'on a phone': {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true}})) {
  test('has no serious barrier ' + where, async () => {
    const {page, close} = await opened(options);
    if (hasReplay) await page.evaluate((id) => window.prehendReport.openReplay(id), FAILS);
    assert.deepEqual(await serious(page), []);
    const [content, screen] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    assert.ok(content <= screen, `sideways scroll: ${content} of ${screen} px`);
    await close();
  });
}

test('on a phone the tools do not cover the title', async () => {
  const {page, close} = await opened({hash: '#' + FAILS, viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true});
  const covered = await page.evaluate((id) => {
    const title = document.getElementById(id).querySelector('h2').getBoundingClientRect();
    const tools = document.getElementById('tools').getBoundingClientRect();
    return tools.bottom > title.top && tools.top < title.bottom;
  }, FAILS);
  assert.equal(covered, false);
  await close();
});

test('a whole suite has at most 15 MB', async (context) => {
  if (!SUITE_PAGE) return context.skip('no page of a suite was given');
  const size_mb = statSync(SUITE_PAGE).size / 1e6;
  assert.ok(size_mb <= 15, `${size_mb.toFixed(1)} MB`);
  const begin = Date.now();
  const {page, seen, close} = await opened({file: SUITE_PAGE});
  await page.keyboard.press('n');
  const count = await page.locator('section.scenario').count();
  context.diagnostic(`${count} scenarios, ${size_mb.toFixed(1)} MB, usable after ${((Date.now() - begin) / 1000).toFixed(2)} s`);
  assert.deepEqual(seen.complaints, []);
  await close();
});

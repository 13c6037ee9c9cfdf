// SPDX-License-Identifier: Apache-2.0
// The page that compares labels with what was recognised, in Chromium. Started by tests/page/run.
import {strict as assert} from 'node:assert';
import {spawnSync} from 'node:child_process';
import {copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {before, test} from 'node:test';
import {openPage, prehend, serious} from './browser.mjs';

const HERE = process.cwd() + '/labels', FILE = HERE + '/page.html', DOCS = process.env.PROJECT + '/docs/motion_capture';
const GOOD = readFileSync(DOCS + '/labels.csv', 'utf8');
const TAKES = ['take1.jsonl', 'take2.jsonl'].map((name) => `${HERE}/${name}`);
// The second take has three faults: a hold that begins a second late, a placing that nobody marked, a lift where none is.
const FAULTY = GOOD.replace('1.1,3.8,hold', '2.6,3.8,hold').replace(/.*put down.*\n/, '') + '4.2,4.6,lift,right\n';
const RATE = 30, BITS = 10, OFFSET = 0.25;
const LABELS = ['--truth', HERE + '/labels', '--map', HERE + '/labels.yaml'];
let hasVideo;

/// A video whose frames have their numbers burnt in, as stripes: the lowest bit is left.
function makeVideo(file) {
  const stripes = `geq=lum='if(mod(floor(N/pow(2,floor(X/32))),2),235,16)':cb=128:cr=128`;
  return spawnSync('ffmpeg', ['-loglevel', 'error', '-y', '-f', 'lavfi', '-i', `color=black:s=${32 * BITS}x240:r=${RATE}:d=6`, '-vf', stripes,
    '-pix_fmt', 'yuv420p', file]).status === 0;
}

before(() => {
  rmSync(HERE, {recursive: true, force: true});
  mkdirSync(HERE + '/labels', {recursive: true});
  prehend('import', DOCS + '/poses.csv', '--map', DOCS + '/bodies.yaml', '-o', TAKES[0]);
  copyFileSync(TAKES[0], TAKES[1]);
  hasVideo = makeVideo(HERE + '/take1.mp4') && makeVideo(HERE + '/take2.webm');
  if (!hasVideo) console.error('\nSKIPPED: the video beside the timeline: ffmpeg is not installed\n');
  writeFileSync(HERE + '/labels/take1.csv', GOOD);
  writeFileSync(HERE + '/labels/take2.csv', FAULTY);
  // The video began later than the tracker; labels are in its clock.
  const video = hasVideo ? 'video: {take1: take1.mp4, take2: take2.webm}\n' : '';
  writeFileSync(HERE + '/labels.yaml', `offset_s: ${OFFSET}\ncollar_ms: {reaching: 400, grasping: 400}\n` + video + readFileSync(DOCS + '/labels.yaml', 'utf8'));
  for (const take of ['take1', 'take2']) {
    const lines = readFileSync(`${HERE}/labels/${take}.csv`, 'utf8').trim().split('\n');
    const moved = lines.map((line, i) => (i === 0 ? line : line.replace(/^([\d.]+),([\d.]+)/, (_, a, b) => `${(a - OFFSET).toFixed(3)},${(b - OFFSET).toFixed(3)}`)));
    writeFileSync(`${HERE}/labels/${take}.csv`, moved.join('\n') + '\n');
  }
  prehend('report', ...TAKES, ...LABELS, '-o', FILE);
});

const opened = (options) => openPage({file: FILE, viewport: {width: 1400, height: 900}, ...options});

test('labels, events and differences are rows, with the figures of score; the worst take is first', async () => {
  const {page, seen, close} = await opened();
  assert.deepEqual(await page.evaluate(() => window.prehendReport.scenarios()), ['take2', 'take1']);
  for (const call of ['labelsOf', 'cursorOf', 'setCursor', 'openReplay'])
    await assert.rejects(page.evaluate((name) => window.prehendReport[name](), call), /no scenario is called 'undefined'; scenarios\(\) lists them/);
  assert.deepEqual(await page.locator('section.chosen p.sides span').allTextContents(), ['labels', 'pick_and_place_from_motion']);
  const lanes = await page.locator('section.chosen svg.timeline').evaluate((svg) => {
    const top = (each) => each.getBoundingClientRect().top;
    const hold = (what) => svg.querySelector(`rect[data-event^="grasping"][data-lane="${what}"]`);
    return [top(hold(0)), top(hold(1)), top(svg.querySelector('path.hatch'))];
  });
  assert.ok(lanes[0] < lanes[1], String(lanes));
  const figures = await page.locator('header details pre').last().textContent();
  assert.equal(figures, prehend('score', ...TAKES, ...LABELS, '--verbose'));
  const {grammars} = JSON.parse(prehend('score', ...TAKES, ...LABELS, '--json'));
  const row = await page.locator('table.figures').first().locator('tr').last().locator('td').allTextContents();
  assert.equal(Number(row[2]), Number((100 * grammars[0].total.f1_50).toFixed(1)), JSON.stringify(grammars[0].total));
  assert.deepEqual(seen.complaints, []);
  await close();
});

test('three faults in labels are found, and what is accepted is read by score', async () => {
  const {page, close} = await opened();
  const listed = page.locator('section.chosen ol.choices li');
  await listed.nth(2).waitFor();  // they are listed when the page has seen that the section is in view
  const choices = await listed.allTextContents();
  assert.equal(choices.length, 3, choices.join('\n'));
  assert.match(choices[0], /^grasping\(right_hand, milk\)1: 2\.60.3\.80 s2: 1\.48.4\.15 s/);
  assert.match(choices[1], /^putting_down\(right_hand, milk\)1: nothing2: 3\.31/);
  assert.match(choices[2], /^picking_up\(right_hand, milk\)1: 4\.20.4\.60 s2: nothing/);
  for (let i = 0; i < 3; ++i) {
    await page.keyboard.press('d');
    await page.keyboard.press('2');
  }
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'save as labels, 3 changes'}).click()]);
  assert.equal(download.suggestedFilename(), 'take2.csv');
  await download.saveAs(HERE + '/saved/take2.csv');
  const total = (...truth) => JSON.parse(prehend('score', TAKES[1], '--truth', ...truth, '--json')).grammars[0].total;
  const saved = total(HERE + '/saved');
  assert.deepEqual([saved.f1_50, saved.truths ?? saved.true, saved.found], [1, 5, 5], JSON.stringify(saved));
  // Where the first side is accepted, labels are as they were.
  writeFileSync(HERE + '/as_labelled.csv', await page.evaluate(() => {
    document.querySelectorAll('section.chosen .choices li').forEach((each) => each.querySelectorAll('.chip')[0].click());
    return window.prehendReport.labelsOf('take2');
  }));
  const byEvent = (...truth) => JSON.parse(prehend('score', TAKES[1], '--truth', ...truth, '--json')).grammars[0].events;
  const labelled = byEvent(...LABELS.slice(1)), again = byEvent(HERE + '/as_labelled.csv');
  const compared = ({event, true: truths, found, f1_50, begin_ms, end_ms}) => ({event, truths, found, f1_50, begin_ms, end_ms});
  assert.equal(again.length, 5);
  assert.deepEqual(again.map(compared), labelled.map(compared));
  await close();
});

test('what was decided is there again when the page is loaded again', async () => {
  const {page, close} = await opened();
  const pressed = () => page.locator('section.chosen .choices [aria-pressed=true]').allTextContents();
  await page.keyboard.press('d');
  await page.keyboard.press('2');
  await page.keyboard.press('d');
  await page.keyboard.press('1');
  const [decided, saved] = [await pressed(), await page.evaluate(() => window.prehendReport.labelsOf('take2'))];
  assert.deepEqual(decided.map((each) => each[0]), ['2', '1']);
  await page.reload();
  assert.equal(await page.evaluate(() => window.prehendReport.labelsOf('take2')), saved);
  await page.getByRole('button', {name: 'save as labels, 1 change'}).waitFor();
  assert.deepEqual(await pressed(), decided);
  await page.evaluate(() => {  // of other events nothing is decided
    const [key] = Object.keys(localStorage);
    localStorage.setItem(key + '0', localStorage.getItem(key));
    localStorage.removeItem(key);
  });
  await page.reload();
  await page.keyboard.press('d');
  assert.deepEqual(await pressed(), []);
  await close();
});

test('labels of a moment are saved, too', async () => {
  mkdirSync(HERE + '/points', {recursive: true});
  const points = readFileSync(HERE + '/labels/take1.csv', 'utf8') + '2.5,2.5,hold,right\n0.9,0.9,lift,right\n';
  writeFileSync(HERE + '/points/take1.csv', points);
  const truth = ['--truth', HERE + '/points', '--map', HERE + '/labels.yaml'];
  prehend('report', TAKES[0], ...truth, '-o', HERE + '/points.html');
  const {page, close} = await openPage({file: HERE + '/points.html'});
  assert.match(await page.locator('.moments').textContent(), /^Labels of a moment: grasping\(right_hand, milk\) 2\.75 s/);
  mkdirSync(HERE + '/saved_points', {recursive: true});
  writeFileSync(HERE + '/saved_points/take1.csv', await page.evaluate(() => window.prehendReport.labelsOf('take1')));
  const score = (...words) => JSON.parse(prehend('score', TAKES[0], ...words, '--json')).grammars[0];
  const [labelled, saved] = [score(...truth), score('--truth', HERE + '/saved_points')];
  assert.deepEqual(Object.keys(saved.moments).sort(), ['grasping', 'picking_up']);
  assert.deepEqual(saved.moments, labelled.moments);
  assert.deepEqual([saved.total.true, saved.total.found, saved.total.f1_50], [labelled.total.true, labelled.total.found, labelled.total.f1_50]);
  await close();
});

test('the video shows the frame of the cursor', async (context) => {
  if (!hasVideo) return context.skip('no ffmpeg');
  for (const take of ['take1', 'take2']) {
    const {page, close} = await opened({hash: '#' + take});
    const video = page.locator('section.chosen video');
    for (const seconds of [0.5, 2.0401, 1.3333, 4.9]) {
      await page.evaluate(([id, at]) => window.prehendReport.setCursor(id, at), [take, seconds]);
      await page.waitForFunction(([at, offset]) => {
        const film = document.querySelector('section.chosen video');
        return !film.seeking && film.readyState >= 2 && Math.abs(film.currentTime - (at - offset)) < 0.01;
      }, [seconds, OFFSET]);
      await page.waitForTimeout(100);
      const image = (await video.screenshot()).toString('base64');
      const frame = await page.evaluate(async ([png, bits]) => {
        const bitmap = await createImageBitmap(await (await fetch('data:image/png;base64,' + png)).blob());
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        canvas.drawImage(bitmap, 0, 0);
        let number = 0;
        for (let k = 0; k < bits; ++k)
          if (canvas.getImageData((k + 0.5) * bitmap.width / bits, bitmap.height * 0.2, 1, 1).data[0] > 128) number += 2 ** k;
        return number;
      }, [image, BITS]);
      assert.ok(Math.abs(frame - Math.floor((seconds - OFFSET) * RATE)) <= 1, `${take} at ${seconds} s: frame ${frame}`);
    }
    const [timeline, film] = [await page.locator('section.chosen svg.timeline').boundingBox(), await video.boundingBox()];
    assert.ok(film.x >= timeline.x + timeline.width && film.y < timeline.y + timeline.height, 'beside the timeline');
    await close();
  }
});

for (const [where, options] of Object.entries({
  'on a desktop': {}, 'in the dark': {colorScheme: 'dark'}, 'on a phone': {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true}})) {
  test('has no serious barrier ' + where, async () => {
    const {page, close} = await opened(options);
    assert.deepEqual(await serious(page), []);
    const [content, screen] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    assert.ok(content <= screen, `sideways scroll: ${content} of ${screen} px`);
    await close();
  });
}

test('a hundred takes open in three seconds', async (context) => {
  const folder = HERE + '/many', takes = [];
  mkdirSync(folder + '/labels', {recursive: true});
  for (let i = 1; i <= 100; ++i) {
    takes.push(`${folder}/take${i}.jsonl`);
    copyFileSync(TAKES[0], takes.at(-1));
    copyFileSync(`${HERE}/labels/take${1 + i % 2}.csv`, `${folder}/labels/take${i}.csv`);
  }
  prehend('report', ...takes, '--truth', folder + '/labels', '--map', HERE + '/labels.yaml', '-o', folder + '/page.html');
  const begin = Date.now();
  const {page, seen, busy_s, close} = await openPage({file: folder + '/page.html', viewport: {width: 1400, height: 900}});
  await page.keyboard.press('d');
  assert.equal(await page.locator('li[aria-current]').count(), 1);
  const busy = await busy_s();
  context.diagnostic(`100 takes, usable after ${((Date.now() - begin) / 1000).toFixed(2)} s, ${busy.toFixed(2)} s of them busy`);
  assert.ok(busy < 3, `${busy} s`);
  assert.equal(await page.locator('section.scenario').count(), 100);
  assert.deepEqual(seen.complaints, []);
  await close();
});

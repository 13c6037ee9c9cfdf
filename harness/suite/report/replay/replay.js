// SPDX-License-Identifier: Apache-2.0
// The 3D replay of the report page. Defines window.prehendReplay = {mount(place, data, moved)}: fills the element `place`
// with a player of `data` (harness/show/replay/replay_data.h) and calls moved(seconds) whenever its time changes. The player
// that it returns is described in docs/report-page.md. Throws if there is no WebGL.
import {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, Color, CylinderGeometry, DirectionalLight,
  DoubleSide, EdgesGeometry, FrontSide, GridHelper, Group, HemisphereLight, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4,
  Mesh, MeshBasicMaterial, MeshLambertMaterial, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Quaternion, Scene,
  ShadowMaterial, SphereGeometry, Vector3, WebGLRenderer, Box3
} from 'three';
import {RoundedBoxGeometry} from 'three/addons/geometries/RoundedBoxGeometry.js';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';

const UNITS_PER_M = 10000, COARSE_PER_M = 1000, SKIN = '#e0ac86';
const VIEWS = ['fitted', 'front', 'side', 'top', 'hand', 'eyes'];
const LAYERS = [
  ['regions', 'regions of interest'], ['contacts', 'contacts'], ['paths', 'paths'], ['gaze', 'gaze'], ['body', 'body'],
  ['names', 'names']];

const NEAR = [];  // where a name may stand, the nearest first, in pixels
for (let right = -160; right <= 160; right += 20) for (let down = -160; down <= 160; down += 10) NEAR.push([right, down]);
NEAR.sort((a, b) => Math.hypot(...a) + (a[1] > 0 ? 40 : 0) - Math.hypot(...b) - (b[1] > 0 ? 40 : 0));

function sums(differences, width) {
  const values = Float64Array.from(differences);
  for (let i = width; i < values.length; ++i) values[i] += values[i - width];
  return values;
}

/// Poses over time: before its first key the first, after its last the last.
class Track {
  constructor(packed) {
    this.t = sums(packed.t, 1);
    this.p = sums(packed.p, 3).map((v) => v / UNITS_PER_M);
    this.q = sums(packed.q, 4);
    this.moves = this.t.length > 1;
    this.a = new Quaternion();
    this.b = new Quaternion();
  }
  turned(i, into) {
    return into.set(this.q[4 * i + 1], this.q[4 * i + 2], this.q[4 * i + 3], this.q[4 * i]).normalize();
  }
  set(tick, object) {
    const n = this.t.length;
    let low = 0, high = n - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.t[middle] <= tick) low = middle; else high = middle;
    }
    const span = this.t[high] - this.t[low];
    const share = span > 0 ? Math.min(1, Math.max(0, (tick - this.t[low]) / span)) : 0;
    const mix = (k) => this.p[3 * low + k] + share * (this.p[3 * high + k] - this.p[3 * low + k]);
    object.position.set(mix(0), mix(1), mix(2));
    object.quaternion.copy(this.turned(low, this.a)).slerp(this.turned(high, this.b), share);
  }
}

function geometryOf(shape) {
  if (shape.kind === 'box') return new BoxGeometry(...shape.size);
  if (shape.kind === 'sphere') return new SphereGeometry(shape.radius, 24, 16);
  if (shape.kind === 'cylinder')
    return new CylinderGeometry(shape.radius, shape.radius, shape.length, 32).rotateX(Math.PI / 2);
  if (shape.kind === 'capsule') return new CapsuleGeometry(shape.radius, shape.length, 8, 24).rotateX(Math.PI / 2);
  const corners = [];
  for (const triangle of shape.triangles) for (const i of triangle) corners.push(...shape.corners[i]);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(corners), 3));
  geometry.computeVertexNormals();
  return geometry;
}

function solid(geometry, color, opacity) {
  const group = new Group();
  const clear = opacity < 1;
  const mesh = new Mesh(geometry, new MeshLambertMaterial(
    {color, transparent: clear, opacity, depthWrite: !clear, side: clear ? DoubleSide : FrontSide}));
  mesh.castShadow = mesh.receiveShadow = !clear;
  group.add(mesh);
  const edges = new LineBasicMaterial({color: new Color(color).multiplyScalar(0.55), transparent: clear, opacity});
  group.add(new LineSegments(new EdgesGeometry(geometry, 40), edges));
  return group;
}

/// Of a hand: without edges. Fingers are as round as they are thin, and long enough to leave no notches at their joints.
function link(size, round) {
  const radius = Math.min(round, 0.475 * Math.min(size[1], size[2]));
  const mesh = new Mesh(new RoundedBoxGeometry(size[0] + (round > 0.1 ? 0.9 * radius : 0), size[1], size[2], 4, radius), new MeshLambertMaterial({color: SKIN}));
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

/// A hint of one, which is nothing in the physics: as in the stills.
function forearm([length, width]) {
  const radius = 0.36 * width, material = new MeshLambertMaterial({color: SKIN, transparent: true, opacity: 0.55});
  return new Mesh(new CapsuleGeometry(radius, 0.17, 8, 24).rotateZ(Math.PI / 2).translate(-length / 2 - 0.085 - 0.6 * radius, 0, 0), material);
}

class World {
  constructor(data) {
    this.data = data;
    this.scene = new Scene();
    this.layers = {regions: [], contacts: [], paths: [], gaze: [], body: [], names: []};
    this.placed = [];  // [object, track]
    this.objects = {};
    this.named = [];
    this.scene.add(new HemisphereLight(0xffffff, 0x8d8d8d, 1.9), new AmbientLight(0xffffff, 0.4));
    const sun = new DirectionalLight(0xffffff, 2.1);
    this.sun = sun;
    this.scene.add(sun, sun.target);
    data.bodies.forEach((body) => this.addBody(body));
    data.legs.forEach((leg) => {
      const mesh = solid(new BoxGeometry(...leg.size), leg.color, 1);
      mesh.position.set(...leg.p);
      this.scene.add(mesh);
    });
    data.hands.forEach((hand) => this.addHand(hand));
    data.gazes.forEach((gaze) => this.addGaze(gaze));
    this.addContacts();
    this.box = this.bounds();
    this.addGround();
    this.addPaths();
  }

  place(object, packed, name) {
    const track = new Track(packed);
    this.placed.push([object, track]);
    if (name) this.objects[name] = object;
    return track;
  }

  addBody(body) {
    const group = new Group();
    const isRegion = body.kind === 'region';
    const opacity = isRegion ? 0.25 : body.kind === 'gaze_target' ? 0.5 : 1;
    for (const shape of body.shapes) {
      const part = solid(geometryOf(shape), body.color, opacity);
      part.position.set(...shape.X.p);
      part.quaternion.set(shape.X.q[1], shape.X.q[2], shape.X.q[3], shape.X.q[0]);
      group.add(part);
    }
    if (body.grains) this.addGrains(body);
    const track = this.place(group, body.track, body.name);
    this.scene.add(group);
    if (isRegion || body.kind === 'gaze_target') this.layers.regions.push(group);
    if (body.kind === 'person') this.layers.body.push(group);
    else if (body.kind !== 'fixed') this.named.push([body.name, group]);
    if (body.kind === 'thing' && track.moves) group.userData.path = track;
  }

  addGrains(body) {
    const grains = new InstancedMesh(
      new SphereGeometry(body.grains.radius, 8, 6), new MeshLambertMaterial({color: body.color}), body.grains.count);
    grains.frustumCulled = false;
    const places = sums(body.grains.places.samples, 3 * body.grains.count);
    this.scene.add(grains);
    (this.grains = this.grains || []).push({grains, places, of: body.grains});
  }

  addHand(hand) {
    const group = new Group();
    group.add(link(hand.palm, 0.012));
    const isGripper = hand.links.length < 6, hasArm = this.data.bodies.some((body) => body.kind === 'person' && body.name.includes('forearm'));
    if (!isGripper && !hasArm) group.add(forearm(hand.palm));
    hand.links.forEach((one) => {
      const part = link(one.size, 1);
      this.place(part, one.track);
      group.add(part);
    });
    group.userData.path = this.place(group, hand.track, hand.name);
    group.userData.phases = hand.phases;
    this.scene.add(group);
    this.named.push([hand.name, group]);
  }

  addGaze(gaze) {
    const line = new Line2(new LineGeometry().setPositions([0, 0, 0, 0, 0, 1]), new LineMaterial({color: 0xd6249f, linewidth: 2}));
    line.frustumCulled = false;
    const hit = new Mesh(new SphereGeometry(0.015, 16, 12), new MeshBasicMaterial({color: 0xd6249f}));
    this.scene.add(line, hit);
    this.layers.gaze.push(line, hit);
    (this.gazes = this.gazes || []).push({line, hit, values: sums(gaze.rays.samples, 6), rays: gaze.rays});
  }

  addContacts() {
    const most = Math.max(1, ...this.data.contacts.samples.map((points) => points.length / 3));
    this.points = new InstancedMesh(
      new SphereGeometry(0.0025, 8, 6), new MeshBasicMaterial({color: 0xffc400, depthTest: false, transparent: true, opacity: 0.6}), most);
    this.points.frustumCulled = false;
    this.points.renderOrder = 2;
    this.scene.add(this.points);
    this.layers.contacts.push(this.points);
  }

  /// Of what moves, with its size, and of people. Collects `seen`, what a picture of everything has to hold.
  bounds() {
    const box = new Box3(), point = new Vector3(), around = new Box3();
    this.seen = [];
    const add = (one) => {
      box.union(one);
      for (let k = 0; k < 8; ++k)
        this.seen.push(new Vector3(k & 1 ? one.max.x : one.min.x, k & 2 ? one.max.y : one.min.y, k & 4 ? one.max.z : one.min.z));
    };
    this.scene.traverse((object) => {
      const track = object.userData.path;
      if (!track) return;
      const half = object.userData.phases ? 0.1 : 0.06;
      for (let i = 0, every = Math.ceil(track.t.length / 100); i < track.t.length; i += every)
        add(around.setFromCenterAndSize(point.fromArray(track.p, 3 * i), new Vector3(2 * half, 2 * half, 2 * half)));
    });
    if (box.isEmpty()) {
      this.seek(0);
      add(around.setFromObject(this.scene));
    }
    for (const [object, track] of this.placed) {  // heads of people, wherever they lean
      if (!this.layers.body.includes(object)) continue;
      for (const tick of [0, this.data.end / 2, this.data.end]) {
        track.set(tick, object);
        object.updateMatrixWorld(true);
        add(around.setFromObject(object));
      }
    }
    return box.expandByScalar(0.15);
  }

  addGround() {
    const lowest = this.data.bodies.reduce((z, body) => Math.min(z, body.track.p[2] / UNITS_PER_M), 0);
    const grid = new GridHelper(4, 20, 0x888888, 0x888888);
    grid.rotation.x = Math.PI / 2;
    const middle = this.box.getCenter(new Vector3());
    grid.position.set(middle.x, middle.y, Math.min(0, lowest) - 0.002);
    grid.material.transparent = true;
    grid.material.opacity = 0.25;
    const ground = new Mesh(new PlaneGeometry(8, 8), new ShadowMaterial({opacity: 0.25}));
    ground.position.copy(grid.position);
    ground.receiveShadow = true;
    this.scene.add(grid, ground);
    const {sun} = this, reach = Math.max(1, this.box.getSize(new Vector3()).length()), view = sun.shadow.camera;
    sun.target.position.copy(middle);
    sun.position.copy(middle).add(new Vector3(-1, -2, 4).normalize().multiplyScalar(2 * reach));
    Object.assign(view, {left: -reach, right: reach, top: reach, bottom: -reach, far: 6 * reach});
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    sun.shadow.bias = -0.0005;
    sun.shadow.normalBias = 0.002;
  }

  /// What moves, pale, as it is at this tick; null: nothing.
  ghost(tick) {
    if (tick === null) {
      if (this.ghosts) this.ghosts.visible = false;
      return;
    }
    if (!this.ghosts) {
      this.ghosts = new Group();
      const pale = new MeshLambertMaterial({color: 0x5b7fa6, transparent: true, opacity: 0.35, depthWrite: false});
      this.shades = this.placed.filter(([object, track]) => object.parent === this.scene && track.moves)
        .map(([object]) => [object, object.clone()]);
      for (const [, shade] of this.shades) {
        shade.traverse((part) => {
          if (part.isLineSegments) part.visible = false;
          if (part.isMesh) Object.assign(part, {material: pale, castShadow: false, receiveShadow: false});
        });
        this.ghosts.add(shade);
      }
      this.scene.add(this.ghosts);
    }
    this.ghosts.visible = true;
    for (const [object, track] of this.placed) track.set(tick, object);
    const copy = (from, to) => {
      to.position.copy(from.position);
      to.quaternion.copy(from.quaternion);
      from.children.forEach((child, i) => copy(child, to.children[i]));
    };
    for (const [object, shade] of this.shades) copy(object, shade);
  }

  addPaths() {
    const probe = new Group();
    const paths = [];
    this.scene.traverse((object) => { if (object.userData.path) paths.push(object); });
    for (const object of paths) {
      const points = [], colors = [], color = new Color();
      const step = this.data.ticks_per_second / 60;
      for (let tick = 0; tick <= this.data.end; tick += step) {
        object.userData.path.set(tick, probe);
        points.push(probe.position.x, probe.position.y, probe.position.z);
        const phase = (object.userData.phases || []).find((each) => each.from <= tick && tick < each.to);
        color.set(phase ? phase.color : '#8a8f96');
        colors.push(color.r, color.g, color.b);
      }
      if (points.length < 6) continue;
      const line = new Line2(new LineGeometry().setPositions(points).setColors(colors),
        new LineMaterial({vertexColors: true, linewidth: object.userData.phases ? 3 : 1.5}));
      this.scene.add(line);
      this.layers.paths.push(line);
    }
  }

  seek(tick) {
    for (const [object, track] of this.placed) track.set(tick, object);
    const at = (sampled, width) => {
      const count = width ? sampled.samples.length / width : sampled.samples.length;
      return Math.min(count - 1, Math.max(0, Math.round((tick - sampled.begin) / sampled.every)));
    };
    const move = new Matrix4();
    if (this.points) {
      const points = this.data.contacts.samples[at(this.data.contacts)] || [];
      const size = Math.min(1, Math.sqrt(40 / (points.length / 3)));  // many of them would cover what they mark
      for (let i = 0; i < points.length; i += 3)
        this.points.setMatrixAt(i / 3, move.makeScale(size, size, size).setPosition(
          points[i] / COARSE_PER_M, points[i + 1] / COARSE_PER_M, points[i + 2] / COARSE_PER_M));
      this.points.count = points.length / 3;
      this.points.instanceMatrix.needsUpdate = true;
    }
    for (const {grains, places, of} of this.grains || []) {
      const from = 3 * of.count * at(of.places, 3 * of.count);
      for (let i = 0; i < of.count; ++i)
        grains.setMatrixAt(i, move.makeTranslation(places[from + 3 * i] / COARSE_PER_M,
          places[from + 3 * i + 1] / COARSE_PER_M, places[from + 3 * i + 2] / COARSE_PER_M));
      grains.instanceMatrix.needsUpdate = true;
    }
    for (const {line, hit, values, rays} of this.gazes || []) {
      const from = 6 * at(rays, 6);
      const ray = Array.from(values.slice(from, from + 6), (v) => v / COARSE_PER_M);
      line.geometry.setPositions(ray);
      hit.position.set(ray[3], ray[4], ray[5]);
    }
  }
}

function element(parent, tag, attributes, text) {
  const made = document.createElement(tag);
  for (const name in attributes) made.setAttribute(name, attributes[name]);
  if (text) made.textContent = text;
  parent.appendChild(made);
  return made;
}

class Player {
  constructor(place, data, moved) {
    this.place = place;
    this.moved = moved;
    this.rate = data.ticks_per_second;
    this.end_s = data.end / this.rate;
    this.time = 0;
    this.world = new World(data);
    this.stage = element(place, 'div', {class: 'stage'});
    this.canvas = element(this.stage, 'canvas', {
      tabindex: '0', role: 'img',
      'aria-label': '3D replay; arrows turn the view, + and - zoom, space plays, comma and full stop step'});
    this.renderer = new WebGLRenderer({canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.camera = new PerspectiveCamera(35, 1.6, 0.01, 50);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.addLabels();
    this.addBar();
    this.addKeys();
    this.watcher = new ResizeObserver(() => this.resize());
    this.watcher.observe(this.stage);
    this.world.seek(0);
    this.resize();
    this.view('fitted');
    this.seek(0);
  }

  addLabels() {
    this.labels = this.world.named.map(([name, object]) => {
      const line = element(this.stage, 'span', {class: 'leader', 'aria-hidden': 'true'});
      const label = element(this.stage, 'span', {class: 'label', 'aria-hidden': 'true'}, name);
      return {label, line, object};
    });
  }

  addBar() {
    const time = element(this.place, 'div', {class: 'scrub'});
    const phases = element(time, 'div', {class: 'phases', 'aria-hidden': 'true'});
    for (const hand of this.world.data.hands) {
      const line = element(phases, 'div', {});
      for (const {from, to, name, color} of hand.phases)
        element(line, 'span', {
          title: name, style: `left:${100 * from / this.world.data.end}%;width:${100 * (to - from) / this.world.data.end}%;background:${color}`});
    }
    this.scrubber = element(time, 'input', {
      type: 'range', min: '0', max: String(this.end_s), step: String(1 / this.rate), value: '0',
      'aria-label': 'time of the replay, in seconds'});
    const bar = element(this.place, 'div', {class: 'bar', role: 'group', 'aria-label': 'replay'});
    this.button = element(bar, 'button', {type: 'button', class: 'play'}, 'play');
    this.button.addEventListener('click', () => (this.timer ? this.pause() : this.play()));
    this.scrubber.addEventListener('input', () => { this.pause(); this.seek(Number(this.scrubber.value)); });
    this.clock = element(bar, 'span', {class: 'clock'});
    this.speed = element(bar, 'select', {'aria-label': 'speed'});
    for (const speed of [0.1, 0.25, 0.5, 1, 2, 4])
      element(this.speed, 'option', {value: speed, ...(speed === 1 ? {selected: ''} : {})}, speed + 'x');
    this.views = element(bar, 'select', {'aria-label': 'camera'});
    for (const view of VIEWS) {
      if (view === 'eyes' && !this.world.gazes) continue;
      if (view === 'hand' && this.world.data.hands.length === 0) continue;
      element(this.views, 'option', {value: view}, view);
    }
    this.views.addEventListener('change', () => this.view(this.views.value));
    const layers = element(this.place, 'div', {class: 'bar', role: 'group', 'aria-label': 'what is shown'});
    for (const [layer, title] of LAYERS) {
      if (layer !== 'names' && this.world.layers[layer].length === 0) continue;
      const label = element(layers, 'label');
      const box = element(label, 'input', {type: 'checkbox', checked: ''});
      label.append(' ' + title);
      box.addEventListener('change', () => this.show(layer, box.checked));
    }
  }

  addKeys() {
    this.canvas.addEventListener('keydown', (event) => {
      const turn = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[event.key];
      const away = this.camera.position.clone().sub(this.controls.target);
      if (turn) {
        away.applyAxisAngle(this.camera.up, turn[0]);
        const across = new Vector3().crossVectors(this.camera.up, away).normalize();
        away.applyAxisAngle(across, turn[1]);
      } else if (event.key === '+' || event.key === '-') {
        away.multiplyScalar(event.key === '+' ? 0.9 : 1.1);
      } else if (event.key === ' ') {
        if (this.timer) this.pause(); else this.play();
      } else if (event.key === ',' || event.key === '.') {
        this.pause();
        this.seek(this.time + (event.key === '.' ? 1 : -1) / 30);
      } else {
        return;
      }
      event.preventDefault();
      event.stopPropagation();
      this.camera.position.copy(this.controls.target).add(away);
      this.controls.update();
      this.draw();
    });
  }

  /// Puts the camera where everything is as large as it can be in the picture, seen from `away`.
  fit(away) {
    const back = away.clone().normalize(), right = this.camera.up.clone().cross(back).normalize(), up = back.clone().cross(right);
    const tall = 0.9 * Math.tan(this.camera.fov * Math.PI / 360), at = this.camera.position.set(0, 0, 0);
    let far = 0;
    for (const [axis, slope] of [[right, tall * this.camera.aspect], [up, tall]]) {
      let least = Infinity, most = -Infinity;
      for (const point of this.world.seen) {
        least = Math.min(least, point.dot(axis) - slope * point.dot(back));
        most = Math.max(most, point.dot(axis) + slope * point.dot(back));
      }
      at.addScaledVector(axis, (least + most) / 2);
      far = Math.max(far, (most - least) / 2 / slope);
    }
    const middle = this.world.box.getCenter(new Vector3()).dot(back);
    at.addScaledVector(back, Math.max(far, middle + 0.3));
    this.controls.target.copy(at).addScaledVector(back, middle - at.dot(back));
  }

  resize() {
    const width = this.stage.clientWidth || 640;
    const height = Math.round(Math.min(width * 0.6, 520));
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /// Puts the camera: one of the names in VIEWS.
  view(name) {
    const target = this.world.box.getCenter(new Vector3());
    let away = {front: [-1, 0, 0.25], side: [0, -1, 0.2], top: [0, -0.01, 1]}[name] || [-0.4, -1, 0.6];
    let distance = 0;
    this.camera.near = 0.01;
    if (name === 'hand') {
      this.world.objects[this.world.data.hands[0].name].getWorldPosition(target);
      distance = 0.55;
    }
    const eyes = name === 'eyes' && this.world.gazes && this.world.gazes[0].line.geometry;
    if (eyes) {
      const ray = this.world.gazes[0];
      target.copy(ray.hit.position);
      const from = eyes.attributes.instanceStart;
      away = [from.getX(0) - target.x, from.getY(0) - target.y, from.getZ(0) - target.z];
      distance = Math.max(0.3, new Vector3(...away).length());
      this.camera.near = 0.15;  // her own head is not in the way
    }
    if (distance > 0) {
      this.controls.target.copy(target);
      this.camera.position.copy(target).add(new Vector3(...away).normalize().multiplyScalar(distance));
    } else this.fit(new Vector3(...away));
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.views.value = name;
    this.draw();
  }

  /// Shows or hides a layer: regions, contacts, paths, gaze, body, names.
  show(layer, shown) {
    for (const object of this.world.layers[layer]) object.visible = shown;
    this.renderer.shadowMap.needsUpdate = true;
    if (layer === 'names') this.stage.classList.toggle('nameless', !shown);
    this.draw();
  }

  /// Beside everything, what moves as it is at another time, pale; null: not.
  ghost(seconds) {
    if (seconds === null && !this.world.ghosts) return;
    this.world.ghost(seconds === null ? null : seconds * this.rate);
    this.world.seek(this.time * this.rate);
    this.draw();
  }

  /// Everything as it is at this time, in seconds.
  seek(seconds) {
    this.time = Math.min(this.end_s, Math.max(0, seconds));
    this.world.seek(this.time * this.rate);
    this.renderer.shadowMap.needsUpdate = true;
    this.scrubber.value = String(this.time);
    this.clock.textContent = this.time.toFixed(3) + ' of ' + this.end_s.toFixed(1) + ' s';
    this.draw();
    this.moved(this.time);
  }

  play() {
    if (this.time >= this.end_s) this.seek(0);
    let last = performance.now();
    const step = (now) => {
      this.seek(this.time + Math.min(now - last, 250) / 1000 * Number(this.speed.value));  // nothing is skipped
      last = now;
      if (this.time >= this.end_s) this.pause(); else if (this.timer) this.timer = requestAnimationFrame(step);
    };
    this.timer = requestAnimationFrame(step);
    this.button.textContent = 'pause';
  }

  pause() {
    if (this.timer) cancelAnimationFrame(this.timer);
    this.timer = 0;
    this.button.textContent = 'play';
  }

  /// With the next frame of the browser, whatever changes until then.
  draw() {
    if (!this.frame) this.frame = requestAnimationFrame(() => this.render());
  }

  render() {
    this.frame = 0;
    if (this.gone || !this.labels) return;
    this.renderer.render(this.world.scene, this.camera);
    const width = this.stage.clientWidth, height = this.canvas.clientHeight, at = new Vector3(), taken = [];
    for (const one of this.labels) {
      one.object.getWorldPosition(at).project(this.camera);
      one.isIn = Math.abs(at.x) < 1 && Math.abs(at.y) < 1 && at.z < 1 && one.object.visible;
      one.label.style.visibility = one.line.style.visibility = one.isIn ? '' : 'hidden';
      one.there = {x: (at.x + 1) / 2 * width, y: (1 - at.y) / 2 * height};
      if (one.isIn) taken.push({x: one.there.x, y: one.there.y - 9, half: 16});  // what is named is not covered
    }
    for (const {label, line, there} of this.labels.filter((one) => one.isIn)) {
      const half = 4 * label.textContent.length + 4;
      const isFree = ([x, y]) => x >= half && x <= width - half && y >= 2 && y <= height - 22 &&
        !taken.some((one) => Math.abs(one.y - y) < 20 && Math.abs(one.x - x) < one.half + half);
      // Above it, or as near to that as there is room, with a line to what it names.
      const [x, y] = NEAR.map(([right, down]) => [there.x + right, there.y - 34 + down]).find(isFree) || [there.x, there.y - 34];
      taken.push({x, y, half});
      label.style.transform = `translate(${x}px, ${y}px) translate(-50%, 0)`;
      const from = y + (there.y > y + 9 ? 18 : 0), long = Math.hypot(there.x - x, there.y - from);
      line.style.transform = `translate(${x}px, ${from}px) rotate(${Math.atan2(there.y - from, there.x - x)}rad)`;
      line.style.width = long + 'px';
    }
  }

  /// Where a body or hand is drawn: {p: [x, y, z] in metres, q: [w, x, y, z]}, or null.
  poseOf(name) {
    const object = this.world.objects[name];
    if (!object) return null;
    this.world.scene.updateMatrixWorld();
    const p = object.getWorldPosition(new Vector3()), q = object.getWorldQuaternion(new Quaternion());
    return {p: p.toArray(), q: [q.w, q.x, q.y, q.z]};
  }

  remove() {
    this.pause();
    this.gone = true;
    this.watcher.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.place.replaceChildren();
  }
}

window.prehendReplay = {mount: (place, data, moved) => new Player(place, data, moved)};

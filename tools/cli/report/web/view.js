// The picture: the boundary of the tets that are kept, and the faces that the cut lays bare.

const kPlain = [176, 182, 193];

class View {
    /**
     * @param mesh  as readMesh() has it
     * @param up    the axis that points up: 1 or 2
     * @param onDraw  called with the number of triangles whenever that changes
     */
    constructor(canvas, context, mesh, up, onDraw) {
        this.mesh = mesh;
        this.onDraw = onDraw;
        this.faces = findFaces(mesh.tets, mesh.points.length / 3);
        this.box = new THREE.Box3().setFromArray(mesh.points);
        this.radius = 0.5 * this.box.getSize(new THREE.Vector3()).length();
        this.keys = [null, null, null];
        this.kept = new Uint8Array(mesh.quality.length);
        this.axis = 0, this.part = 0.55, this.otherSide = false, this.coloured = false;

        this.renderer = new THREE.WebGLRenderer({canvas, context});
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
        this.renderer.setClearColor(0x15171b);
        this.scene = new THREE.Scene();
        this.material = triangleMaterial();
        this.surface = new Triangles(this.material);
        this.bare = new Triangles(this.material);
        this.marks = new THREE.Group();
        this.dotCut = {value: new THREE.Vector4()};
        this.scene.add(this.surface.mesh, this.bare.mesh, this.marks);

        this.camera = new THREE.PerspectiveCamera(32, 1, this.radius / 500, this.radius * 40);
        this.camera.up.set(0, up === 1 ? 1 : 0, up === 2 ? 1 : 0);
        this.controls = new THREE.OrbitControls(this.camera, canvas);
        this.controls.enableKeys = false;
        this.controls.addEventListener("change", () => this.request());
        this.home = new THREE.Vector3(0.85, 0.42, 0.9);
        if (up === 2) this.home.set(0.85, -0.9, 0.42);

        this.resize();
        this.reset();
        this.sort();
    }

    /** Look at all of it from the place that the page began with. */
    reset() {
        const middle = this.box.getCenter(new THREE.Vector3()), {points} = this.mesh;
        const z = this.home.clone().normalize(), x = this.camera.up.clone().cross(z).normalize(), y = z.clone().cross(x);
        const tangent = 0.8 * Math.tan(Math.PI / 360 * this.camera.fov), point = new THREE.Vector3();
        let distance = 0; // such that all points are seen, above the controls
        for (let i = 0; i < points.length; i += 3) {
            point.fromArray(points, i).sub(middle);
            const across = Math.max(Math.abs(point.dot(x)) / this.camera.aspect, Math.abs(point.dot(y)));
            distance = Math.max(distance, point.dot(z) + across / tangent);
        }
        this.lookAt(middle, distance, this.home);
    }

    /** Look at a place from so far. */
    lookAt(place, distance, direction = this.camera.position.clone().sub(this.controls.target)) {
        this.controls.target.copy(place);
        this.camera.position.copy(direction).setLength(distance).add(place);
        this.controls.update();
        this.request();
    }

    /** Turn by radians, and come nearer by a factor. */
    turn(right, up, nearer) {
        const offset = this.camera.position.clone().sub(this.controls.target);
        const toY = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
        const at = new THREE.Spherical().setFromVector3(offset.applyQuaternion(toY));
        at.theta += right;
        at.phi -= up;
        at.radius /= nearer;
        at.makeSafe();
        offset.setFromSpherical(at).applyQuaternion(toY.inverse());
        this.lookAt(this.controls.target.clone(), offset.length(), offset);
    }

    /** The place of the cut along its axis, from the middle of the box. */
    get place() {
        const from = this.box.min.getComponent(this.axis), to = this.box.max.getComponent(this.axis);
        // All is kept at the end of the slider.
        return this.part >= 1 ? Infinity : from + this.part * (to - from);
    }

    /** Put the boundary in the order along the axis, so that what is kept of it is a run. */
    sort() {
        const {points, tets, quality} = this.mesh, outer = this.faces.outer;
        const keys = this.keys[this.axis] = this.keys[this.axis] || keysAlong(this.axis, points, tets);
        const order = outer.slice().sort((a, b) => keys[a >> 2] - keys[b >> 2]);
        this.surfaceKeys = Float32Array.from(order, (face) => keys[face >> 2]);
        this.surface.begin(order.length);
        for (const face of order) {
            this.surface.add(this.mesh, face, this.coloured ? kColours[quality[face >> 2]] : kPlain);
        }
        this.surface.end();
        this.cut();
    }

    /** Show the tets on one side of the cut: each that has its centroid there, whole. */
    cut() {
        const place = 4 * this.place, keys = this.keys[this.axis], kept = this.kept;
        const wanted = this.otherSide ? 0 : 1;
        for (let t = 0; t < kept.length; ++t) kept[t] = keys[t] < place ? wanted : 1 - wanted;

        let below = 0, above = this.surfaceKeys.length; // a bisection for the end of the run
        while (below < above) {
            const middle = (below + above) >> 1;
            if (this.surfaceKeys[middle] < place) below = middle + 1;
            else above = middle;
        }
        const run = this.otherSide ? [below, this.surfaceKeys.length] : [0, below];
        this.surface.show(...run);

        const {inner, beyond} = this.faces;
        let count = 0;
        for (let i = 0; i < inner.length; ++i) count += kept[inner[i] >> 2] ^ kept[beyond[i]];
        this.bare.begin(count);
        for (let i = 0; i < inner.length; ++i) {
            const tet = inner[i] >> 2;
            if (kept[tet] === kept[beyond[i]]) continue;
            const owner = kept[tet] ? tet : beyond[i];
            this.bare.add(this.mesh, inner[i], kColours[this.mesh.quality[owner]]);
        }
        this.bare.end();
        const side = this.otherSide ? -1 : 1;
        this.dotCut.value.set(0, 0, 0, side * Math.min(this.place, 1e30)).setComponent(this.axis, -side);
        this.onDraw(run[1] - run[0] + count);
        this.request();
    }

    /** Show a tet through all that hides it. */
    select(tet) {
        if (this.selected) this.scene.remove(this.selected);
        const at = (i) => new THREE.Vector3().fromArray(this.mesh.points, 3 * this.mesh.tets[4 * tet + i]);
        const corners = [0, 1, 2, 3].map(at);
        const lines = new THREE.BufferGeometry().setFromPoints(
            [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].flatMap(([a, b]) => [corners[a], corners[b]]));
        const faces = new THREE.BufferGeometry().setFromPoints(kFaces.flat().map((i) => corners[i]));
        this.selected = new THREE.Group();
        this.selected.add(
            new THREE.Mesh(faces, new THREE.MeshBasicMaterial(
                {color: 0xff5470, transparent: true, opacity: 0.45, depthTest: false, side: THREE.DoubleSide})),
            new THREE.LineSegments(lines, new THREE.LineBasicMaterial({color: 0xffffff, depthTest: false})));
        for (const part of this.selected.children) part.renderOrder = 3;
        this.scene.add(this.selected);
        const middle = corners.reduce((sum, corner) => sum.add(corner), new THREE.Vector3()).multiplyScalar(0.25);
        const size = Math.max(...corners.map((corner) => corner.distanceTo(middle)));
        this.lookAt(middle, 14 * size);
    }

    resize() {
        const {clientWidth: width, clientHeight: height} = this.renderer.domElement.parentElement;
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / Math.max(height, 1);
        this.camera.updateProjectionMatrix();
        this.request();
    }

    /** Draw soon. */
    request() {
        if (this.waiting) return;
        this.waiting = true;
        requestAnimationFrame(() => this.render());
    }

    render() {
        this.waiting = false;
        this.material.uniforms.edges.value = this.edges === false ? 0 : 1;
        this.renderer.render(this.scene, this.camera);
        this.onTurn && this.onTurn(this.camera);
    }
}

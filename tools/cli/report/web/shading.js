// Flat triangles with thin edges, and round marks.

const kTriangleVertex = `
attribute vec4 tint; // and which corner of its triangle it is
varying vec3 vTint, vCorner, vSeen;
void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    float corner = floor(tint.a * 255.0 + 0.5);
    vCorner = vec3(corner == 0.0, corner == 1.0, corner == 2.0);
    vTint = tint.rgb;
    vSeen = seen.xyz;
    gl_Position = projectionMatrix * seen;
}`;

// The normal is that of the flat triangle as it is seen, so it always faces the viewer.
const kTriangleFragment = `
uniform float edges;
varying vec3 vTint, vCorner, vSeen;
void main() {
    vec3 normal = normalize(cross(dFdx(vSeen), dFdy(vSeen)));
    float light = 0.38 + 0.58 * max(dot(normal, normalize(vec3(0.35, 0.55, 0.75))), 0.0)
                       + 0.16 * max(dot(normal, normalize(vec3(-0.8, -0.1, 0.5))), 0.0);
    vec3 width = fwidth(vCorner);
    vec3 near = smoothstep(vec3(0.0), width * 1.1, vCorner);
    float line = 1.0 - min(near.x, min(near.y, near.z));
    // Where triangles are a few pixels small, edges would be all there is.
    float visible = clamp(1.05 - 2.1 * max(width.x, max(width.y, width.z)), 0.0, 1.0);
    gl_FragColor = vec4(mix(vTint * light, vTint * light * 0.55, edges * line * visible), 1.0);
}`;

function triangleMaterial() {
    return new THREE.ShaderMaterial({
        vertexShader: kTriangleVertex, fragmentShader: kTriangleFragment, uniforms: {edges: {value: 1}},
        side: THREE.DoubleSide, extensions: {derivatives: true},
    });
}

/** Three corners a triangle, each a position and a tint. */
class Triangles {
    constructor(material) {
        this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
        this.mesh.frustumCulled = false;
        this.room = 0;
    }

    /** Start anew with room for so many. */
    begin(count) {
        if (count > this.room) {
            this.room = Math.ceil(1.25 * count);
            this.positions = new Float32Array(9 * this.room);
            this.tints = new Uint8Array(12 * this.room);
            this.mesh.geometry.dispose();
            const geometry = this.mesh.geometry = new THREE.BufferGeometry();
            geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 3));
            geometry.setAttribute("tint", new THREE.BufferAttribute(this.tints, 4, true));
            for (const name of ["position", "tint"]) geometry.attributes[name].setUsage(THREE.DynamicDrawUsage);
        }
        this.count = 0;
    }

    add(mesh, face, colour) {
        const at = face & ~3, corners = kFaces[face & 3];
        for (let i = 0; i < 3; ++i) {
            const point = 3 * mesh.tets[at + corners[i]], to = 3 * this.count + i;
            for (let k = 0; k < 3; ++k) {
                this.positions[3 * to + k] = mesh.points[point + k];
                this.tints[4 * to + k] = colour[k];
            }
            this.tints[4 * to + 3] = i;
        }
        ++this.count;
    }

    end() {
        for (const attribute of Object.values(this.mesh.geometry.attributes)) {
            attribute.updateRange = {offset: 0, count: 3 * attribute.itemSize * this.count};
            attribute.needsUpdate = true;
        }
        this.show(0, this.count);
    }

    show(from, to) {
        this.mesh.visible = to > from;
        this.mesh.geometry.setDrawRange(3 * from, 3 * (to - from));
    }
}

/**
 * Round dots of a size in pixels; those behind the mesh shine through faintly.
 * @param cut  a uniform: those are shown for whose places dot(cut, vec4(place, 1)) is not negative
 */
function dots(places, colour, cut) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(places.flat()), 3));
    const group = new THREE.Group();
    for (const [depthTest, opacity] of [[false, 0.22], [true, 1]]) {
        const points = new THREE.Points(geometry, new THREE.ShaderMaterial({
            vertexShader: `
uniform float size;
uniform vec4 cut;
void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_Position.z -= 0.0005 * gl_Position.w; // in front of the faces it is on
    if (dot(cut, vec4(position, 1.0)) < 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // out of sight
    gl_PointSize = size;
}`,
            fragmentShader: `
uniform vec3 colour;
uniform float opacity;
void main() {
    float away = length(gl_PointCoord - 0.5);
    if (away > 0.5) discard;
    gl_FragColor = vec4(away > 0.40 ? vec3(0.06) : colour, opacity);
}`,
            uniforms: {
                cut,
                colour: {value: new THREE.Color(colour)}, opacity: {value: opacity},
                size: {value: (places.length > 200 ? 6 : 8) * Math.min(window.devicePixelRatio, 2)},
            },
            transparent: true, depthTest, depthWrite: false,
        }));
        points.frustumCulled = false;
        points.renderOrder = 2;
        group.add(points);
    }
    return group;
}

// The mesh as the page holds it, and the faces of its tets.

/** The bytes of an array that the page carries as base64. */
function bytesOf(id) {
    const text = atob(document.getElementById(id).textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
}

/**
 * Points: float32, three a point, from the middle of the box. Tets: uint32, four a tet. Quality: a byte a tet, its
 * smallest dihedral angle.
 */
function readMesh() {
    return {
        points: new Float32Array(bytesOf("points").buffer),
        tets: new Uint32Array(bytesOf("tets").buffer),
        quality: bytesOf("quality"),
    };
}

/** The corners of face 0 to 3 of a tet, counter-clockwise from outside. */
const kFaces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/**
 * Who shares which face. A face is 4 times its tet, plus its number.
 * @returns outer: the faces of one tet alone; inner: those of two, each seen from the first tet; beyond: the second
 * tets of these
 */
function findFaces(tets, pointCount) {
    const faceCount = tets.length; // four a tet, as corners
    const lowest = (face) => {
        const at = face & ~3, [a, b, c] = kFaces[face & 3];
        return Math.min(tets[at + a], tets[at + b], tets[at + c]);
    };
    // In order of their lowest corners: those of one corner are few, and matched each with each.
    const first = new Uint32Array(pointCount + 1);
    for (let face = 0; face < faceCount; ++face) ++first[lowest(face) + 1];
    for (let point = 0; point < pointCount; ++point) first[point + 1] += first[point];
    const next = first.slice(), sorted = new Uint32Array(faceCount);
    for (let face = 0; face < faceCount; ++face) sorted[next[lowest(face)]++] = face;

    const outer = [], inner = new Uint32Array(faceCount / 2), beyond = new Uint32Array(faceCount / 2);
    let matched = 0;
    const middle = [], highest = [], open = [];
    for (let point = 0; point < pointCount; ++point) {
        let count = 0;
        for (let i = first[point]; i < first[point + 1]; ++i) {
            const face = sorted[i], at = face & ~3, [p, q, r] = kFaces[face & 3];
            const a = tets[at + p], b = tets[at + q], c = tets[at + r];
            const high = Math.max(a, b, c), mid = a + b + c - high - point;
            let k = 0;
            while (k < count && (middle[k] !== mid || highest[k] !== high)) ++k;
            if (k < count) {
                inner[matched] = open[k];
                beyond[matched++] = face >> 2;
                --count;
                open[k] = open[count], middle[k] = middle[count], highest[k] = highest[count];
            } else {
                open[count] = face, middle[count] = mid, highest[count++] = high;
            }
        }
        for (let k = 0; k < count; ++k) outer.push(open[k]);
    }
    return {
        outer: Uint32Array.from(outer).sort(),
        inner: inner.subarray(0, matched),
        beyond: beyond.subarray(0, matched),
    };
}

/** Four times the tets' centroids along an axis, which says who is cut away first. */
function keysAlong(axis, points, tets) {
    const keys = new Float32Array(tets.length / 4);
    for (let t = 0; t < keys.length; ++t) {
        for (let i = 4 * t; i < 4 * t + 4; ++i) keys[t] += points[3 * tets[i] + axis];
    }
    return keys;
}

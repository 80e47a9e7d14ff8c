// Puts the page together.

const data = JSON.parse(document.getElementById("data").textContent);

const kPlaces = {
    ambiguous: ["ambiguous tets, dropped", "#ffb454"],
    conflicts: ["conflicts of flips", "#ff5470"],
    pinched: ["vertices where the boundary was no surface", "#59c2ff"],
};

function showHeadings() {
    const {run} = data, grid = run.gridName || "unnamed grid";
    document.title = `${grid} – vdbtet report`;
    document.getElementById("title").textContent = grid;
    document.getElementById("subtitle").textContent =
        `${run.gridType}, from ${run.input}${run.output === null ? "; a dry run, which wrote no mesh" : ` to ${run.output}`}`;
    const note = noteOnPicture();
    if (note) show("honesty", note);
}

/** What one must know of the picture; nothing where it is the mesh itself. */
function noteOnPicture() {
    const {run, picture} = data, tets = asCount(run.tets);
    const figures = `All figures are those of the ${tets} tets that the file ${run.output === null ? "would have" : "has"}.`;
    switch (picture.kind) {
    case "whole": return "";
    case "same surface":
        return `The picture is thinned: it shows ${asCount(picture.tets)} tets. Its surface and the tets there are ` +
            `those of the mesh, but inside its tets are larger, with other angles. ${figures}`;
    case "coarser":
        return `The picture is thinned: it shows another mesh of the same volume, of ${asCount(picture.tets)} tets, ` +
            `with a spacing of ${asNumber(picture.spacing)} instead of ${asNumber(run.scale * run.spacing)}, and ` +
            `larger tets inside. ${figures}`;
    default:
        return `There is no picture: ${tets} tets are more than a page can show, and a coarser mesh could not be ` +
            `made${picture.why ? `: ${picture.why}` : ""}.`;
    }
}

/** What the marks mean, with the number of those that the page holds. */
function placeKinds() {
    return Object.entries(kPlaces).map(([kind, [name, colour]]) => {
        const places = data.places[kind];
        const all = kind === "pinched" ? data.run.boundary.found : data.run[kind];
        return {name, colour, places, all};
    }).filter(({all}) => all > 0);
}

function showPlaces(kinds) {
    if (kinds.length === 0) return;
    show("places", ...kinds.map(({name, colour, places, all}) => {
        const dot = element("i", {class: "dot"});
        dot.style.background = colour;
        const some = places.length < all ? `, of which the first ${asCount(places.length)} are marked` : "";
        return element("p", {}, dot, `${asCount(all)} ${name}${some}`);
    }));
}

function showWorst(view) {
    const {small, large} = data.worst;
    const rows = (worst, angle) => worst.map((tet) => {
        const button = element("button", {type: "button"}, asAngle(tet[angle]));
        button.addEventListener("click", () => view.select(tet.tet));
        return button;
    });
    show("worst",
        element("p", {}, data.picture.kind !== "coarser" ? "Go to the tets with the smallest and the largest angles:"
            : "Go to the tets of the picture with the smallest and the largest angles:"),
        element("div", {class: "gos"}, ...rows(small, "min")), element("div", {class: "gos"}, ...rows(large, "max")));
}

function drawAxes(camera) {
    const drawing = document.getElementById("axes");
    drawing.replaceChildren();
    const inverse = camera.quaternion.clone().inverse();
    const ends = ["x", "y", "z"].map((name, i) => ({name, at: new THREE.Vector3().setComponent(i, 1)
        .applyQuaternion(inverse)})).sort((a, b) => a.at.z - b.at.z);
    for (const {name, at} of ends) {
        drawing.append(element("line", {class: name, x1: 0, y1: 0, x2: 24 * at.x, y2: -24 * at.y}),
            element("text", {class: name, x: 33 * at.x, y: 4 - 33 * at.y, "text-anchor": "middle"}, name));
    }
}

function connect(view, kinds) {
    const by = (id) => document.getElementById(id), {center} = data.picture;
    // As many digits as tell a thousandth of the box, wherever it is.
    const digits = Math.min(Math.max(3 - Math.floor(Math.log10(view.radius)), 0), 20);
    const tell = () => {
        by("place").textContent = view.part >= 1 ? "no cut"
            : `${"xyz"[view.axis]} = ${(center[view.axis] + view.place).toFixed(digits)}`;
    };
    for (const radio of document.getElementsByName("axis")) {
        radio.addEventListener("change", () => {
            view.axis = Number(radio.value);
            view.sort();
            tell();
        });
    }
    let waiting = false; // several moves of the slider are one cut
    by("cut").addEventListener("input", () => {
        view.part = by("cut").value / by("cut").max;
        tell();
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => {
            waiting = false;
            view.cut();
        });
    });
    by("other").addEventListener("change", () => {
        view.otherSide = by("other").checked;
        view.cut();
    });
    by("edges").addEventListener("change", () => {
        view.edges = by("edges").checked;
        view.request();
    });
    by("coloured").addEventListener("change", () => {
        view.coloured = by("coloured").checked;
        view.sort();
    });
    by("reset").addEventListener("click", () => {
        if (view.selected) view.scene.remove(view.selected);
        view.reset();
    });
    by("canvas").addEventListener("keydown", (event) => {
        const steps = {ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, 0.1, 1],
            ArrowDown: [0, -0.1, 1], "+": [0, 0, 1.1], "=": [0, 0, 1.1], "-": [0, 0, 1 / 1.1]};
        if (!(event.key in steps) || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        view.turn(...steps[event.key]);
    });

    for (const {places, colour} of kinds) {
        view.marks.add(dots(places.map((place) => place.map((value, i) => value - center[i])), colour, view.dotCut));
    }
    by("marking").hidden = kinds.length === 0;
    by("marks").addEventListener("change", () => {
        view.marks.visible = by("marks").checked;
        view.request();
    });
    new ResizeObserver(() => view.resize()).observe(by("stage"));
    view.onTurn = drawAxes;
    tell();
}

showHeadings();
showCards(data);
showHistogram(data);
showCounts(data);
showStages(data);
show("options", table(data.options));
show("input", table(data.input));
const kinds = placeKinds();
showPlaces(kinds);

/** The picture; not there yet, or where it cannot be, not at all. */
let view = null;

function showPicture() {
    const notice = document.getElementById("notice");
    if (data.picture.tets === 0) {
        notice.textContent = "There is no picture of this mesh; the figures are all here.";
        return;
    }
    const canvas = document.getElementById("canvas"), wish = {antialias: true, alpha: false};
    const context = canvas.getContext("webgl2", wish) || canvas.getContext("webgl", wish);
    if (!context) {
        notice.textContent = "This browser shows no WebGL, so there is no picture; the figures are all here.";
        return;
    }
    drawLegend();
    view = new View(canvas, context, readMesh(), data.picture.up, (triangles) => {
        document.getElementById("drawn").textContent = `${asCount(triangles)} triangles shown`;
    });
    connect(view, kinds);
    showWorst(view);
    notice.hidden = true;
    for (const id of ["legend", "controls"]) document.getElementById(id).hidden = false;
}

// The figures first.
requestAnimationFrame(() => setTimeout(showPicture));

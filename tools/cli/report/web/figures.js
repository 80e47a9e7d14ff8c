// Figures as tables and charts. Texts of the run become text nodes, never markup.

/** An element of the page, or of a drawing. */
function element(name, attributes = {}, ...children) {
    const drawing = ["svg", "g", "rect", "line", "path", "text", "title"].includes(name);
    const made = drawing ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
}

const asCount = (value) => value.toLocaleString("en-GB").replace(/,/g, "\u202f");
const asAngle = (value) => `${value.toFixed(2)}°`;
const asNumber = (value) => String(Number(value.toPrecision(6)));
const asSeconds = (value) => value < 0.9995 ? `${(1000 * value).toFixed(1)} ms` : `${value.toFixed(2)} s`;

function asBytes(bytes) {
    const units = ["bytes", "kB", "MB", "GB", "TB"];
    let unit = 0;
    for (; bytes >= 1000 && unit + 1 < units.length; ++unit) bytes /= 1000;
    return `${unit === 0 ? bytes : bytes.toFixed(1)} ${units[unit]}`;
}

function show(id, ...children) {
    const place = document.getElementById(id);
    place.append(...children);
    place.hidden = false;
}

/** A table of two columns: rows are [key, value]. */
function table(rows) {
    const body = element("tbody");
    for (const [key, value] of rows) {
        body.append(element("tr", {}, element("th", {scope: "row"}, key), element("td", {}, String(value))));
    }
    return element("table", {}, body);
}

function showCards({run}) {
    const cards = [
        ["tets", asCount(run.tets)], ["points", asCount(run.points)],
        ["boundary triangles", asCount(run.boundaryTriangles)],
        ["smallest angle", asAngle(run.angles.min)], ["largest angle", asAngle(run.angles.max)],
        [run.output === null ? "as a file" : "file", asBytes(run.bytes === undefined ? run.bytesAtMost : run.bytes)],
    ];
    show("cards", ...cards.map(([name, value]) =>
        element("div", {class: "card"}, element("b", {}, value), element("span", {}, name))));
}

/** Angles by whole degrees; those of a bin that spans several are spread evenly. */
function byDegree(bins) {
    const counts = new Float64Array(180);
    for (const [low, high, count] of bins) {
        const first = Math.min(Math.floor(low), 179), last = Math.min(Math.floor(high), 179);
        for (let i = first; i <= last; ++i) {
            const part = high > low ? (Math.min(high, i + 1) - Math.max(low, i)) / (high - low) : 1;
            counts[i] += count * Math.max(part, 0);
        }
    }
    return counts;
}

function drawHistogram({run, angleBins}, logarithmic) {
    const {angles} = run, counts = byDegree(angleBins);
    const width = 360, height = 150, left = 4, bottom = height - 18, top = 24;
    const x = (degrees) => left + (width - 2 * left) * degrees / 180;
    const scale = logarithmic ? (count) => Math.log10(1 + count) : (count) => count;
    const most = scale(Math.max(...counts));
    const chart = element("svg", {viewBox: `0 0 ${width} ${height}`, role: "img",
        "aria-label": `Dihedral angles from ${asAngle(angles.min)} to ${asAngle(angles.max)}`});
    for (const [from, to] of [[0, angles.provenMin], [angles.provenMax, 180]]) {
        chart.append(element("rect", {class: "never", x: x(from), y: top, width: x(to) - x(from),
            height: bottom - top}));
    }
    counts.forEach((count, i) => {
        if (count < 0.5) return;
        const y = bottom - (bottom - top) * scale(count) / most;
        chart.append(element("rect", {class: "bar", x: x(i), y, width: x(1) - x(0) + 0.05, height: bottom - y},
            element("title", {}, `${i}° to ${i + 1}°: about ${asCount(Math.round(count))} angles`)));
    });
    const mark = (name, degrees, y, text, anchor) => chart.append(
        element("line", {class: name, x1: x(degrees), x2: x(degrees), y1: y + 3, y2: bottom}),
        element("text", {class: name, x: x(degrees) + (anchor === "end" ? 3 : -3), y, "text-anchor": anchor}, text));
    mark("proven", angles.provenMin, 8, `proven > ${asAngle(angles.provenMin)}`, "start");
    mark("proven", angles.provenMax, 8, `proven < ${asAngle(angles.provenMax)}`, "end");
    mark("measured", angles.min, 19, asAngle(angles.min), "start");
    mark("measured", angles.max, 19, asAngle(angles.max), "end");
    for (let degrees = 0; degrees <= 180; degrees += 30) {
        chart.append(element("text", {class: "tick", x: Math.min(Math.max(x(degrees), 8), width - 12),
            y: height - 4, "text-anchor": "middle"}, `${degrees}°`));
    }
    chart.append(element("line", {class: "base", x1: x(0), x2: x(180), y1: bottom, y2: bottom}));
    return chart;
}

function showHistogram(data) {
    const {angles, optimizedTo} = data.run, log = element("input", {type: "checkbox", checked: ""});
    let chart = drawHistogram(data, true);
    log.addEventListener("change", () => {
        const other = drawHistogram(data, log.checked);
        chart.replaceWith(other);
        chart = other;
    });
    const rows = angles.percents.map((percent, i) =>
        [`${percent} % are`, `below ${asAngle(angles.low[i])}, as many above ${asAngle(angles.high[i])}`]);
    if (angles.minBefore !== angles.min || angles.maxBefore !== angles.max) {
        rows.push(["before optimising", `${asAngle(angles.minBefore)} to ${asAngle(angles.maxBefore)}`]);
    }
    show("histogram", chart, element("label", {class: "log"}, log, element("span", {}, "logarithmic")),
         element("p", {}, `${asCount(6 * data.run.tets)} angles, six a tet, by whole degrees.`), table(rows));
}

function showCounts({run}) {
    const rows = [["tets", asCount(run.tets)]];
    if (run.tetsOfLevel.length > 1) {
        run.tetsOfLevel.forEach((count, level) =>
            rows.push([`with edges up to ${asNumber(run.spacing * 2 ** level)}`, asCount(count)]));
    }
    rows.push(["points", asCount(run.points)], ["boundary triangles", asCount(run.boundaryTriangles)],
        ["ambiguous tets, dropped", asCount(run.ambiguous)], ["conflicts", asCount(run.conflicts)],
        ["flips", `${asCount(run.activeFlips)} active, ${asCount(run.extraFlips)} extra, ` +
            `${asCount(run.lastResortFlips)} last resort`],
        ["boundary not a surface at", `${asCount(run.boundary.found)} vertices`]);
    if (run.boundary.found > 0) {
        rows.push(["mended by", `${asCount(run.boundary.filled)} tets filled, ${asCount(run.boundary.peeled)} ` +
            `taken out, ${asCount(run.boundary.split)} points doubled; ${asCount(run.boundary.left)} left`]);
    }
    if (run.verticesMoved > 0) {
        rows.push(["points moved", `${asCount(run.verticesMoved)} in ${run.sweeps} sweeps`]);
    }
    rows.push(["surface tiles", asCount(run.surfaceTiles)], ["cut edges", asCount(run.cutEdges)]);
    show("counts", table(rows));
}

function showStages({run}) {
    const most = Math.max(...run.stages.map((stage) => stage.seconds), 1e-9);
    const body = element("tbody");
    for (const {name, seconds} of run.stages) {
        const bar = element("i", {class: "time"});
        bar.style.width = `${100 * seconds / most}%`;
        body.append(element("tr", {}, element("th", {scope: "row"}, name), element("td", {class: "bar"}, bar),
            element("td", {}, asSeconds(seconds))));
    }
    body.append(element("tr", {class: "total"}, element("th", {scope: "row"}, "in all"), element("td"),
        element("td", {}, asSeconds(run.seconds))));
    show("stages", element("table", {}, body));
}

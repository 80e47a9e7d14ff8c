// The colours of angles: magma but for its darkest end, its lightness growing evenly from kFrom degrees to kTo, the
// angle of the lattice's own tets.
const kFrom = 10, kTo = 60;
const kStops = ["2c115f", "51127c", "721f81", "932b80", "b73779", "d8456c", "f1605d", "fb8861", "feb078", "fed799", "fcfdbf"]
    .map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));

/** Red, green and blue, 0 to 255, of an angle in degrees. */
function colourOf(degrees) {
    const at = Math.min(Math.max((degrees - kFrom) / (kTo - kFrom), 0), 1) * (kStops.length - 1);
    const below = Math.min(Math.floor(at), kStops.length - 2), part = at - below;
    return kStops[below].map((value, i) => Math.round(value + part * (kStops[below + 1][i] - value)));
}

/** Of a byte of the array "quality". */
const kDegreesPerByte = 72 / 255;
const kColours = Array.from({length: 256}, (_, byte) => colourOf(byte * kDegreesPerByte));

function drawLegend() {
    const canvas = document.getElementById("ramp"), context = canvas.getContext("2d");
    for (let x = 0; x < canvas.width; ++x) {
        const [r, g, b] = colourOf(kFrom + (kTo - kFrom) * (x + 0.5) / canvas.width);
        context.fillStyle = `rgb(${r}, ${g}, ${b})`;
        context.fillRect(x, 0, 1, 1);
    }
    const ticks = document.getElementById("ticks");
    for (let degrees = kFrom; degrees <= kTo; degrees += 10) {
        const tick = document.createElement("span");
        tick.textContent = `${degrees}°${degrees === kTo ? " +" : ""}`;
        ticks.append(tick);
    }
}

"""What the report's page shows, in headless Chromium. Usage: see support.py."""
import json
import os
import shutil
import sys

from support import Page, PageTest, main

import browser

#: The pixels of the picture: how many are not background, and how many colours there are.
LOOK = """
    view.render();
    const gl = view.renderer.getContext(), width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const pixels = new Uint8Array(4 * width * height), colours = new Set();
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let drawn = 0;
    for (let i = 0; i < pixels.length; i += 4) {
        const colour = pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2];
        colours.add(colour);
        drawn += colour !== 0x15171b;
    }
    const middle = 4 * (width * (height >> 1) + (width >> 1));
    return {share: drawn / (width * height), colours: colours.size,
            middle: pixels[middle] << 16 | pixels[middle + 1] << 8 | pixels[middle + 2]};
"""

#: Sets the slider as a hand would, and waits for the cut.
CUT = """
    const slider = document.getElementById("cut");
    slider.value = VALUE;
    slider.dispatchEvent(new Event("input", {bubbles: true}));
"""


class Browser(PageTest):
    def setUp(self):
        super().setUp()
        if not browser.is_installed():
            print("SKIPPED: chromium or chromedriver is missing; see tools/install_deps.sh --ci")
            sys.exit(77)

    def open(self, window, path="report.html"):
        window.open(path)
        window.wait_for("view || !document.getElementById('notice').textContent.startsWith('Reading')")

    def assert_quiet(self, window, path="report.html"):
        """The page reported no error, and asked for nothing but itself."""
        self.assertEqual([entry["message"] for entry in window.log("browser")], [])
        events = [json.loads(entry["message"])["message"] for entry in window.log("performance")]
        asked = [event["params"]["request"]["url"] for event in events
                 if event["method"] == "Network.requestWillBeSent"]
        self.assertEqual([url for url in asked if not url.startswith("data:")],
                         ["file://" + os.path.abspath(path)])

    def triangles(self, window):
        return int("".join(filter(str.isdigit, window.run("return document.getElementById('drawn').textContent"))))

    def cut_at(self, window, value):
        """@return the number of triangles that are shown then."""
        window.run(CUT.replace("VALUE", str(value)))
        window.run("view.cut()") # as the next frame would
        return self.triangles(window)

    def test_picture(self):
        self.report("sphere.vdb")
        with browser.Browser() as window:
            self.open(window)
            look = window.run(LOOK)
            self.assertGreater(look["share"], 0.1)
            self.assertLess(look["share"], 0.9)
            self.assertGreater(look["colours"], 50)
            self.assertNotEqual(look["middle"], 0x15171B)
            window.run("view.part = 0; view.cut()")
            self.assertEqual(window.run(LOOK)["share"], 0)
            self.assert_quiet(window)

    def test_cut(self):
        self.report("sphere.vdb")
        page = Page("report.html")
        faces = list(page.faces().values())
        with browser.Browser() as window:
            self.open(window)
            self.assertEqual(window.run("return view.faces.outer.length"), page.data["run"]["boundaryTriangles"])
            self.assertEqual(window.run("return view.faces.inner.length"), sum(len(face) == 2 for face in faces))
            self.assertEqual(self.cut_at(window, 1000), page.data["run"]["boundaryTriangles"])
            whole = window.run(LOOK)
            for axis in range(3):
                window.run(f"document.getElementsByName('axis')[{axis}].click()")
                low, high = (end(point[axis] for point in page.points) for end in (min, max))
                middles = [sum(page.points[corner][axis] for corner in tet) / 4 for tet in page.tets]
                for value in (137, 611):
                    place = low + value / 1000 * (high - low)
                    # No centroid is so close to the cut that rounding would tell.
                    self.assertGreater(min(abs(middle - place) for middle in middles), 1e-6)
                    kept = [middle < place for middle in middles]
                    expected = sum(sum(kept[tet] for tet in face) == 1 for face in faces)
                    self.assertEqual(self.cut_at(window, value), expected)
                    self.assertNotEqual(window.run(LOOK), whole)
                    window.run("document.getElementById('other').click()")
                    others = sum(sum(not kept[tet] for tet in face) == 1 for face in faces)
                    self.assertEqual(self.triangles(window), others)
                    window.run("document.getElementById('other').click()")
            self.assert_quiet(window)

    def test_slider_moves_the_picture_by_itself(self):
        self.report("sphere.vdb")
        with browser.Browser() as window:
            self.open(window)
            before = self.triangles(window)
            drawn = "document.getElementById('drawn').textContent"
            window.run(f"window.before = {drawn}")
            shown = window.run("return document.getElementById('place').textContent")
            window.run(CUT.replace("VALUE", "200"))
            window.wait_for(f"{drawn} !== window.before")
            self.assertLess(self.triangles(window), before)
            self.assertNotEqual(window.run("return document.getElementById('place').textContent"), shown)

    def test_camera_and_choices(self):
        self.report("lace.vdb")
        with browser.Browser() as window:
            self.open(window)
            place = "return view.camera.position.toArray().map((x) => x.toFixed(6)).join()"
            home = window.run(place)
            window.run("document.getElementById('canvas').dispatchEvent("
                       "new KeyboardEvent('keydown', {key: 'ArrowLeft', cancelable: true}))")
            self.assertNotEqual(window.run(place), home)
            window.run("document.getElementById('reset').click()")
            self.assertEqual(window.run(place), home)
            plain = window.run(LOOK)
            for choice in ("edges", "coloured", "marks"):
                window.run(f"document.getElementById('{choice}').click()")
                self.assertNotEqual(window.run(LOOK), plain, choice)
                window.run(f"document.getElementById('{choice}').click()")
                self.assertEqual(window.run(LOOK), plain, choice)
            window.run("document.querySelector('#worst button').click()")
            self.assertNotEqual(window.run(place), home)
            self.assertNotEqual(window.run(LOOK), plain)
            self.assertIn("ambiguous tets", window.run("return document.getElementById('places').textContent"))
            self.assert_quiet(window)

    def test_figures(self):
        self.report("sphere.vdb")
        run = Page("report.html").data["run"]
        with browser.Browser() as window:
            self.open(window)
            panel = window.run("return document.getElementById('panel').textContent").replace("\u202f", "")
            for figure in (run["tets"], run["points"], run["boundaryTriangles"]):
                self.assertIn(str(figure), panel)
            for angle in ("min", "max", "provenMin", "provenMax"):
                self.assertIn(f"{run['angles'][angle]:.2f}°", panel)
            for stage in run["stages"]:
                self.assertIn(stage["name"], panel)
            self.assertGreater(window.run("return document.querySelectorAll('#histogram rect.bar').length"), 60)
            self.assertTrue(window.run("return document.getElementById('honesty').hidden"))

    def test_thinned_page_says_so(self):
        self.report("sphere.vdb", "--dry-run", "-v", "0.25", out=None)
        data = Page("report.html").data
        with browser.Browser() as window:
            self.open(window)
            self.assertFalse(window.run("return document.getElementById('honesty').hidden"))
            note = window.run("return document.getElementById('honesty').textContent").replace("\u202f", "")
            self.assertIn("thinned", note)
            self.assertIn(str(data["picture"]["tets"]), note)
            self.assertIn(str(data["run"]["tets"]), note)
            self.assertGreater(window.run(LOOK)["share"], 0.1)
            self.assert_quiet(window)

    def test_hostile_names_are_texts(self):
        name = "<img src=x onerror=stop()>.vdb"
        shutil.copy("hostile.vdb", name)
        self.report(name)
        grid = Page("report.html").data["run"]["gridName"]
        with browser.Browser() as window:
            self.open(window)
            self.assertEqual(window.run("return document.getElementById('title').textContent"), grid)
            self.assertIn(name, window.run("return document.getElementById('subtitle').textContent"))
            self.assertEqual(window.run("return document.querySelectorAll('img').length"), 0)
            self.assertNotEqual(window.run("return document.title"), "run")
            self.assertIn("<i>value</i>", window.run("return document.getElementById('input').textContent"))
            self.assert_quiet(window)

    def test_page_without_webgl(self):
        self.report("sphere.vdb")
        with browser.Browser(webgl=False) as window:
            self.open(window)
            self.assertIn("no WebGL", window.run("return document.getElementById('notice').textContent"))
            self.assertFalse(window.run("return document.getElementById('notice').hidden"))
            self.assertTrue(window.run("return document.getElementById('controls').hidden"))
            self.assertGreater(window.run("return document.querySelectorAll('#histogram rect.bar').length"), 60)

    def test_page_without_picture(self):
        self.report("sphere.vdb")
        page = Page("report.html")
        page.data["picture"].update(kind="none", tets=0, why="<b>too thin</b>")
        text = page.text.replace(page.element("data"), json.dumps(page.data).replace("<", "\\u003c"))
        with open("none.html", "w", encoding="utf-8") as file:
            file.write(text)
        with browser.Browser() as window:
            self.open(window, "none.html")
            self.assertIn("no picture", window.run("return document.getElementById('notice').textContent"))
            self.assertIn("<b>too thin</b>", window.run("return document.getElementById('honesty').textContent"))
            self.assertGreater(window.run("return document.querySelectorAll('#histogram rect.bar').length"), 60)
            self.assert_quiet(window, "none.html")

    def test_narrow_window(self):
        self.report("sphere.vdb")
        with browser.Browser(width=500, height=900) as window:
            self.open(window)
            wide = window.run("return [document.documentElement.scrollWidth, window.innerWidth]")
            self.assertLessEqual(wide[0], wide[1])
            self.assertGreater(window.run(LOOK)["share"], 0.05)


if __name__ == "__main__":
    main()

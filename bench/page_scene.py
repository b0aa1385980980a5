"""How quickly the scene of a report's page is there and turns, in Chromium without a window, WebGL by software.

page_scene.py REPORT.html [WIDTH]: size of the page, the time from the start of its script to the first frame of its first
scene, and frames a second while that is turned by a hundredth of a radian a frame, each read back so that it counts when it
is drawn. One run; the machine should have nothing else to do.
"""
import http.server
import json
import pathlib
import subprocess
import sys
import tempfile
import threading

FRAMES = 100
TIMEOUT_S = 120

PROBE = """<script>
addEventListener('load', () => {
  const tell = (what) => fetch('/measured', {method: 'POST', body: JSON.stringify(what)});
  const wait = () => {
    const scene = (window.stiffscopeScenes || [])[0];
    const none = document.querySelector('[data-scene^="none"]');
    if (none) return tell({none: none.dataset.scene});
    if (!scene) return setTimeout(wait, 20);
    const gl = scene.renderer.getContext(), pixel = new Uint8Array(4);
    const drawn = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    drawn();
    const times = [];
    const step = () => {
      scene.turn(0.01, 0);
      drawn();
      times.push(performance.now());
      if (times.length <= %d) return requestAnimationFrame(step);
      const apart = times.slice(1).map((t, i) => t - times[i]).sort((a, b) => a - b);
      tell({first_frame_ms: scene.firstFrame_ms, width: scene.width, height: scene.height,
            frames_per_s: 1000 * (times.length - 1) / (times[times.length - 1] - times[0]),
            slowest_of_twenty_ms: apart[Math.floor(0.95 * apart.length)]});
    };
    requestAnimationFrame(step);
  };
  wait();
});
</script>""" % FRAMES


def measure(page, width):
    text = page.read_text(encoding="utf-8")
    body = text.replace("</body>", PROBE + "</body>", 1).encode("utf-8")
    if len(body) == len(text.encode("utf-8")):
        raise SystemExit("{}: no </body>".format(page))
    answer, arrived = {}, threading.Event()

    class Handler(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def reply(self, content):
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def do_GET(self):
            self.reply(body if self.path == "/" else b"")

        def do_POST(self):
            answer.update(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.reply(b"")
            arrived.set()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory() as profile:
        # A debugging port keeps the browser open until it is ended.
        browser = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--no-first-run",
             "--hide-scrollbars", "--disable-background-networking", "--remote-debugging-port=0",
             "--window-size={},1000".format(width), "--user-data-dir=" + profile,
             "http://127.0.0.1:{}/".format(server.server_port)],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            if not arrived.wait(TIMEOUT_S):
                raise SystemExit("{}: no answer of the page in {} s".format(page, TIMEOUT_S))
        finally:
            browser.terminate()
            browser.wait()
            server.shutdown()
    return answer


def main():
    if len(sys.argv) not in (2, 3):
        raise SystemExit(__doc__)
    page = pathlib.Path(sys.argv[1])
    found = measure(page, int(sys.argv[2]) if len(sys.argv) == 3 else 1400)
    if "none" in found:
        raise SystemExit("{}: {}".format(page, found["none"]))
    print("{}: {:.2f} MB, scene of {:.0f} x {:.0f} pixels, first frame after {:.0f} ms, {:.1f} frames a second, "
          "one in twenty takes {:.0f} ms or more".format(
              page, page.stat().st_size / 1e6, found["width"], found["height"], found["first_frame_ms"],
              found["frames_per_s"], found["slowest_of_twenty_ms"]))


if __name__ == "__main__":
    main()

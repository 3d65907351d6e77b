// Hostile drawings run nothing and load nothing; strangers get no answer.
import { check, drag, edit, folder, open, quiet } from "./harness.mjs";

const HOSTILE = `<?xml version="1.0"?>
<?xml-stylesheet href="http://127.0.0.1:9/style.css"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 200 100" onload="window.hacked=1">
  <script>window.hacked = 1; parent.hacked = 1;</script>
  <style>@import url(http://127.0.0.1:9/a.css); rect { background: url(http://127.0.0.1:9/b.png) }</style>
  <foreignObject width="200" height="100"><iframe xmlns="http://www.w3.org/1999/xhtml" src="javascript:parent.hacked=1"/><img xmlns="http://www.w3.org/1999/xhtml" src="x" onerror="window.hacked=1"/></foreignObject>
  <a xlink:href="javascript:window.hacked=1"><rect x="10" y="10" width="80" height="60" fill="teal" onclick="window.hacked=1"/></a>
  <image xlink:href="http://127.0.0.1:9/c.png" width="20" height="20"/>
  <use xlink:href="http://127.0.0.1:9/d.svg#x"/>
  <rect id="stage" class="knob" x="110" y="20" width="60" height="60" fill="url(http://127.0.0.1:9/e.svg#f)" style="fill:orange;background:url(http://127.0.0.1:9/g.png)"/>
  <set attributeName="onmouseover" to="window.hacked=1"/>
  <animate attributeName="href" values="javascript:window.hacked=1" begin="0s"/>
</svg>`;

export async function hostile_drawings_do_nothing() {
  const dir = folder({ "evil.svg": HOSTILE });
  const editor = await edit(`${dir}/evil.svg`);
  const page = await open(editor.address);
  try {
    await drag(page, "shaper/0.0/2", 20, 30);
    await page.mouse.click(500, 400);
    await page.keyboard.press("b");
    await quiet(page, 20);
    check((await page.evaluate(() => window.hacked)) === undefined, "a script has run");
    const tags = await page.$$eval("#stage .art *", (all) => [...new Set(all.map((e) => e.localName))]);
    check(!tags.some((t) => ["script", "foreignObject", "a", "style", "iframe", "animate", "set"].includes(t)), tags.join());
    const strange = page.requests.filter((url) => !url.startsWith("blob:") && !url.startsWith("data:") && !url.startsWith(new URL(editor.address).origin));
    check(strange.length === 0, `it asked for ${strange}`);
    check(page.problems.length === 0, page.problems.join("; "));
  } finally {
    editor.stop();
    await page.context().close();
  }
}

export async function strangers_get_no_answer() {
  const dir = folder({ "a.svg": "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><path d='M1,1 H8 V8 Z'/></svg>" });
  const editor = await edit(`${dir}/a.svg`);
  const url = new URL(editor.address);
  const status = async (path, headers = {}, method = "GET") => {
    const { request } = await import("node:http");
    return new Promise((resolve, reject) => {
      const r = request({ host: "127.0.0.1", port: url.port, path, headers, method }, (answer) => {
        answer.resume();
        resolve(answer.statusCode);
      });
      r.on("upgrade", (answer, socket) => {
        socket.destroy();
        resolve(answer.statusCode);
      });
      r.on("error", reject);
      r.end();
    });
  };
  const upgrade = { Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==" };
  try {
    const whole = `/${url.search}`;
    const rows = [
      [whole, {}, "GET", 200], ["/", {}, "GET", 403], ["/?token=wrong", {}, "GET", 403], [whole, {}, "POST", 405],
      [whole, { Host: "evil.example" }, "GET", 403], [whole, { Host: `evil.example:${url.port}` }, "GET", 403],
      [whole, { Origin: "http://evil.example" }, "GET", 403], [`/nothing${url.search}`, {}, "GET", 404],
      [`/socket${url.search}`, { ...upgrade, Origin: url.origin }, "GET", 101],
      [`/socket${url.search}`, upgrade, "GET", 403], ["/socket", { ...upgrade, Origin: url.origin }, "GET", 403],
      [`/socket${url.search}`, { ...upgrade, Origin: "http://evil.example" }, "GET", 403],
    ];
    for (const [path, headers, method, expected] of rows) {
      const got = await status(path, headers, method);
      check(got === expected, `${method} ${path.slice(0, 14)} ${JSON.stringify(headers)}: ${got}, not ${expected}`);
    }
  } finally {
    editor.stop();
  }
}

// Bundles the viewer into one HTML file, ../assets/viewer.html, in which the Rust crate puts the data of a run.
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const result = await build({
  entryPoints: ["src/main.ts"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "inline",
  write: false,
});
const script = result.outputFiles[0].text.replaceAll("</script", "<\\/script");
const style = (await readFile("node_modules/uplot/dist/uPlot.min.css", "utf8")) + (await readFile("src/style.css", "utf8"));
const page = await readFile("src/index.html", "utf8");
await writeFile(
  process.argv[2] ?? "../assets/viewer.html",
  page
    .replace("<!--STYLE-->", () => `<style>\n${style}</style>`)
    .replace("<!--SCRIPT-->", () => `<script>\n${script}</script>`),
);

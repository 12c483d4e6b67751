/// <reference types="vitest/config" />
import { defineConfig, type Plugin } from "vite";

// The page is three files of fixed names, so that the program can embed them and a report can hold them in one:
// index.html refers to page.css and page.js once each, by the two lines below, and to nothing else.
const styleLine = '<link rel="stylesheet" href="page.css">';
const scriptLine = '<script src="page.js"></script>';

function fixedNames(): Plugin {
  return {
    name: "fixed-names",
    enforce: "post",
    transformIndexHtml: (html) =>
      html
        .replace(/\s*<script[^>]*src="[^"]*"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace("</head>", `  ${styleLine}\n  </head>`)
        .replace("</body>", `  ${scriptLine}\n  </body>`),
    generateBundle(_options, bundle) {
      for (const file of Object.values(bundle)) {
        // What would end a <script> early when the code stands in one.
        if (file.type === "chunk") file.code = file.code.replace(/<\/(?=script)/gi, "<\\/").replace(/<!--/g, "<\\!--");
      }
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [fixedNames()],
  esbuild: { legalComments: "none" },
  server: { fs: { allow: ["../.."] } },
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    rollupOptions: {
      output: {
        format: "iife",
        inlineDynamicImports: true,
        entryFileNames: "page.js",
        assetFileNames: (asset) => (asset.names.some((name) => name.endsWith(".css")) ? "page.css" : "[name][extname]"),
      },
    },
  },
  test: { include: ["src/**/*.test.ts"], css: true },
});

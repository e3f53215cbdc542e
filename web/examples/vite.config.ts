import { defineConfig } from "vite";

export default defineConfig({
    optimizeDeps: { exclude: ["bsm-decoder"] }, // the server for development would move its threads away from it
    build: { chunkSizeWarningLimit: 1000, rollupOptions: { input: ["first/index.html", "r3f/index.html", "gltf/index.html", "babylon/index.html", "sequence/index.html"] } },
});

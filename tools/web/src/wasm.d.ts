declare module "*.wasm" {
    const bytes: Uint8Array<ArrayBuffer>;
    export default bytes;
}

/** A script of its own, bundled, as text. */
declare module "worker:*" {
    const script: string;
    export default script;
}

declare module "*.html" {
    const text: string;
    export default text;
}

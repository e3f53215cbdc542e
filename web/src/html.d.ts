declare module "*/player.html" {
    /** Name, attributes and children of an element, as `scripts/build.mjs` reads the page. */
    export type Tree = [tag: string, attributes: Record<string, string>, ...inside: Tree[]];
    export const style: string;
    const trees: Tree[];
    export default trees;
}
declare module "*.html" {
    const text: string;
    export default text;
}
declare module "*.wasm" {
    const bytes: Uint8Array<ArrayBuffer>;
    export default bytes;
}

/** The part of the page that cards and buttons leave free for the mesh. */

/** Pixels from the left and top of the page. */
export type Area = Record<"left" | "top" | "right" | "bottom", number>;

const LEAST = 90; // pixels: what is narrower holds no mesh

/** Where the visible ones of some elements are, as one area; undefined where all are hidden. */
function around(root: HTMLElement, selector: string): Area | undefined {
    const { left, top } = root.getBoundingClientRect();
    const boxes = [...root.querySelectorAll(selector)]
        .map((element) => element.getBoundingClientRect())
        .filter(({ width, height }) => width * height > 0);
    if (boxes.length === 0 || root.hasAttribute("data-bare")) return undefined;
    const sides = boxes.flatMap((box) => [box.left - left, box.right - left]);
    const ends = boxes.flatMap((box) => [box.top - top, box.bottom - top]);
    return { left: Math.min(...sides), top: Math.min(...ends), right: Math.max(...sides), bottom: Math.max(...ends) };
}

/** Areas that nothing covers, of which one is to be chosen; those of a half of the page where it shows two meshes. */
export function freeAreas(root: HTMLElement, beside: number): Area[] {
    const [width, height] = [root.clientWidth / beside, root.clientHeight];
    const card = around(root, ".bsm-side > *") ?? { left: 0, top: 0, right: 0, bottom: 0 };
    const tools = around(root, ".bsm-tools > *") ?? { left: width, top: 0, right: width, bottom: 0 };
    const under = [".bsm-dock > *", ".bsm-tag", ".bsm-ruler"].map((name) => around(root, name)?.top ?? height);
    const bottom = Math.min(height, ...under);
    const below = { left: 0, top: Math.max(card.bottom, tools.bottom), right: width, bottom };
    const others = [
        { left: 0, top: card.bottom, right: tools.left, bottom },
        { left: card.right, top: 0, right: tools.left, bottom },
        { left: card.right, top: tools.bottom, right: width, bottom },
    ];
    const large = [below, ...(beside > 1 ? [] : others)].filter(
        ({ left, top, right, bottom }) => right - left > LEAST && bottom - top > LEAST,
    );
    return large.length > 0 ? large : [{ left: 0, top: 0, right: width, bottom: height }];
}

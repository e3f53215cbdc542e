/** The controls of the page by name, and its texts and panels by the name of their part. */
export class Form {
    constructor(readonly root: HTMLElement) {}

    control<Kind extends HTMLElement = HTMLInputElement>(name: string): Kind {
        return this.root.querySelector<Kind>(`[name=${name}]`)!;
    }

    part(name: string): HTMLElement {
        return this.root.querySelector<HTMLElement>(`[data-part=${name}]`)!;
    }

    on(name: string, type: string, act: (control: HTMLInputElement) => void): void {
        for (const control of this.root.querySelectorAll<HTMLInputElement>(`[name=${name}]`))
            control.addEventListener(type, () => act(control));
    }

    say(part: string, text: string): void {
        const element = this.part(part);
        if (element.textContent !== text) element.textContent = text;
    }

    /** The value of the chosen radio button. */
    picked(name: string): string {
        return this.root.querySelector<HTMLInputElement>(`[name=${name}]:checked`)?.value ?? "";
    }

    pick(name: string, value: string): void {
        this.root.querySelector<HTMLInputElement>(`[name=${name}][value="${value}"]:not(:disabled)`)?.click();
    }

    /** Open a panel, or close it if it is open; close the others. */
    unfold(part: string): void {
        for (const each of ["panel", "keys"]) {
            const hidden = each !== part || !this.part(each).hidden;
            this.part(each).hidden = hidden;
            this.control(each).setAttribute("aria-expanded", String(!hidden));
        }
    }
}

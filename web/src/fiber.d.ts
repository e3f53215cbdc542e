/** What is used of React Three Fiber, which is there in pages that use `react.ts`. */
declare module "@react-three/fiber" {
    import type { Loader } from "three";

    export function useLoader<Result, Kind extends new () => Loader<Result>>(
        loader: Kind,
        url: string,
        extend?: (loader: InstanceType<Kind>) => void,
    ): Result;
}

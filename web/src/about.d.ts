declare module 'virtual:about' {
  /** What roverd is made of: the tables of the README. */
  const packages: readonly {
    readonly name: string;
    readonly version: string;
    readonly licence: string;
  }[];
  export default packages;
}

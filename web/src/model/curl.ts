// Each call of the interface as a line for the shell, made from its OpenAPI document: what is
// required, with values that the document allows. Pure.

export interface Schema {
  $ref?: string;
  type?: string | string[];
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema;
  enum?: unknown[];
  const?: unknown;
  default?: unknown;
  example?: unknown;
  examples?: unknown[];
  minimum?: number;
  exclusiveMinimum?: number;
  maximum?: number;
  minItems?: number;
  oneOf?: Schema[];
  anyOf?: Schema[];
  allOf?: Schema[];
}
interface Parameter {
  $ref?: string;
  name?: string;
  in?: string;
  required?: boolean;
  schema?: Schema;
}
export interface Operation {
  parameters?: Parameter[];
  requestBody?: { required?: boolean; content: Record<string, { schema?: Schema }> };
  'x-code-samples'?: { lang: string; label: string; source: string }[];
}
export interface Document {
  servers?: { url: string }[];
  paths: Record<string, Record<string, Operation>>;
  [more: string]: unknown;
}

/** How deep an example goes; a schema may hold itself. */
const DEEPEST = 6;

/** What "#/components/schemas/Goal" names in the document, or nothing. */
const at_pointer = (document: Document, pointer: string): unknown =>
  pointer
    .replace(/^#\//, '')
    .split('/')
    .reduce<unknown>(
      (object, key) =>
        typeof object === 'object' && object !== null
          ? (object as Record<string, unknown>)[key.replace(/~1/g, '/').replace(/~0/g, '~')]
          : undefined,
      document,
    );

const resolved = <T extends { $ref?: string }>(document: Document, object: T): T =>
  object.$ref === undefined ? object : ((at_pointer(document, object.$ref) ?? {}) as T);

const number_in = (schema: Schema): number => {
  if (schema.minimum !== undefined && schema.minimum > 0) return schema.minimum;
  const above = schema.exclusiveMinimum !== undefined && schema.exclusiveMinimum >= 0;
  const one = above ? (schema.exclusiveMinimum ?? 0) + 1 : 1;
  return schema.maximum !== undefined && schema.maximum < one ? schema.maximum : one;
};

const object_of = (document: Document, schema: Schema, depth: number): Record<string, unknown> => {
  const required = schema.required ?? [];
  const known = Object.keys(schema.properties ?? {});
  const names = required.length > 0 ? required : known.slice(0, 1);
  return Object.fromEntries(
    names.map((name) => [name, example_of(document, schema.properties?.[name] ?? {}, depth + 1)]),
  );
};

/** The smallest value that the schema allows, as far as it says. */
export const example_of = (document: Document, given: Schema, depth = 0): unknown => {
  const schema = resolved(document, given);
  for (const told of [schema.example, schema.examples?.[0], schema.const, schema.default])
    if (told !== undefined && told !== null) return told;
  if (schema.enum) return schema.enum.find((word) => word !== null) ?? null;
  if (depth > DEEPEST) return null;
  if (schema.allOf) {
    const parts = schema.allOf.map((part) => example_of(document, part, depth + 1));
    return Object.assign({}, ...parts) as unknown;
  }
  const one = (schema.oneOf ?? schema.anyOf)?.[0];
  if (one && !schema.properties) return example_of(document, one, depth + 1);
  const types = Array.isArray(schema.type) ? schema.type : [schema.type];
  switch (types.find((type) => type !== 'null')) {
    case 'object':
      return object_of(
        document,
        { ...schema, required: schema.required ?? one?.required ?? [] },
        depth,
      );
    case 'array': {
      const item = example_of(document, schema.items ?? {}, depth + 1);
      return Array.from({ length: Math.max(1, schema.minItems ?? 1) }, () => item);
    }
    case 'number':
    case 'integer':
      return number_in(schema);
    case 'boolean':
      return true;
    case 'string':
      return 'text';
    default:
      return schema.properties ? object_of(document, schema, depth) : null;
  }
};

/** In single quotes where the shell would read it otherwise. */
export const quoted = (text: string): string =>
  /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replace(/'/g, `'\\''`)}'`;

const query_of = (document: Document, parameters: Parameter[]): string => {
  const needed = parameters.filter((p) => p.in === 'query' && p.required === true);
  const words = needed.map((p) => {
    const value = example_of(document, p.schema ?? {});
    return `${p.name ?? ''}=${encodeURIComponent(String(value))}`;
  });
  return words.length > 0 ? `?${words.join('&')}` : '';
};

const body_words = (document: Document, operation: Operation): string[] => {
  const content = operation.requestBody?.content ?? {};
  const [type] = Object.keys(content);
  if (type === undefined) return [];
  const schema = content[type]?.schema;
  if (!type.endsWith('json') || !schema) return ['--data-binary', '@FILE'];
  const value = example_of(document, schema);
  const is_empty = typeof value === 'object' && value !== null && Object.keys(value).length === 0;
  if (operation.requestBody?.required !== true && (value === null || is_empty)) return [];
  return ['-H', `Content-Type: ${type}`, '-d', JSON.stringify(value)];
};

/** "curl -s -X PUT …", ready to be pasted. @param origin "http://127.0.0.1:8080" */
export const curl_of = (
  document: Document,
  origin: string,
  path: string,
  method: string,
): string => {
  const operation = document.paths[path]?.[method] ?? {};
  const parameters = (operation.parameters ?? []).map((p) => resolved(document, p));
  const headers = parameters.filter((p) => p.in === 'header' && p.required === true);
  // Any revision will do in an example.
  const header_words = headers.flatMap((p) => ['-H', `${p.name ?? ''}: *`]);
  const body = body_words(document, operation);
  const usual = method === 'get' || (method === 'post' && body.length > 0);
  const base = document.servers?.[0]?.url ?? '';
  const filled = path.replace(/\{(\w+)\}/g, (_, name: string) => name.toUpperCase());
  const words = [
    'curl',
    '-s',
    ...(usual ? [] : ['-X', method.toUpperCase()]),
    ...header_words,
    ...body,
  ];
  return [...words, `${origin}${base}${filled}${query_of(document, parameters)}`]
    .map(quoted)
    .join(' ');
};

const METHODS = new Set(['get', 'put', 'post', 'delete', 'patch', 'options', 'head']);

/** The document with a line for the shell beside each call. */
export const with_curl = (document: Document, origin: string): Document => ({
  ...document,
  paths: Object.fromEntries(
    Object.entries(document.paths).map(([path, methods]) => [
      path,
      Object.fromEntries(
        Object.entries(methods).map(([method, operation]) => {
          if (!METHODS.has(method)) return [method, operation];
          const source = curl_of(document, origin, path, method);
          const samples = [{ lang: 'bash', label: 'curl', source }];
          return [method, { ...operation, 'x-code-samples': samples }];
        }),
      ),
    ]),
  ),
});

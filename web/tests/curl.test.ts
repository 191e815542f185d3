import { describe, expect, test } from 'vitest';

import { curl_of, type Document, example_of, quoted, with_curl } from '../src/model/curl';

const api: Document = {
  servers: [{ url: '/api/v1' }],
  components: {
    schemas: {
      Goal: {
        type: 'object',
        required: ['lat', 'lon'],
        properties: {
          lat: { type: 'number', minimum: -90, maximum: 90 },
          lon: { type: 'number', example: 26.729 },
          speed_mps: { type: 'number' },
        },
      },
      Tree: {
        type: 'object',
        required: ['child'],
        properties: { child: { $ref: '#/components/schemas/Tree' } },
      },
    },
    parameters: { Match: { name: 'If-Match', in: 'header', required: true } },
  },
  paths: {
    '/vehicle': { get: {} },
    '/vehicle/arm': {
      post: { requestBody: { content: { 'application/json': { schema: { type: 'object' } } } } },
    },
    '/vehicle/goto': {
      post: {
        requestBody: {
          required: true,
          content: { 'application/json': { schema: { $ref: '#/components/schemas/Goal' } } },
        },
      },
    },
    '/missions/{id}': {
      patch: {
        parameters: [{ $ref: '#/components/parameters/Match' }],
        requestBody: {
          required: true,
          content: {
            'application/json': {
              schema: {
                type: 'object',
                properties: { name: { type: 'string', example: "Jüri's" } },
              },
            },
          },
        },
      },
    },
    '/missions/import': {
      post: {
        parameters: [
          { name: 'format', in: 'query', schema: { enum: ['plan'] } },
          {
            name: 'name',
            in: 'query',
            required: true,
            schema: { type: 'string', example: 'a b&c' },
          },
        ],
        requestBody: { required: true, content: { 'application/octet-stream': {} } },
      },
    },
  },
};
const line = (path: string, method: string): string => curl_of(api, 'http://r:8080', path, method);

describe('a call as a line for the shell', () => {
  test('reading needs no more than the address', () => {
    expect(line('/vehicle', 'get')).toBe('curl -s http://r:8080/api/v1/vehicle');
  });
  test('a body that nobody needs is left out, and the method is said', () => {
    expect(line('/vehicle/arm', 'post')).toBe('curl -s -X POST http://r:8080/api/v1/vehicle/arm');
  });
  test('a body holds what is required, with values that are allowed', () => {
    expect(line('/vehicle/goto', 'post')).toBe(
      `curl -s -H 'Content-Type: application/json' -d '{"lat":1,"lon":26.729}' http://r:8080/api/v1/vehicle/goto`,
    );
  });
  test('places in the path, required headers and quotes in values survive the shell', () => {
    expect(line('/missions/{id}', 'patch')).toBe(
      `curl -s -X PATCH -H 'If-Match: *' -H 'Content-Type: application/json' -d '{"name":"Jüri'\\''s"}' http://r:8080/api/v1/missions/ID`,
    );
  });
  test('a file is sent as it is, and a query is encoded', () => {
    expect(line('/missions/import', 'post')).toBe(
      `curl -s --data-binary @FILE 'http://r:8080/api/v1/missions/import?name=a%20b%26c'`,
    );
  });
  test('a word that the shell would read is quoted, another one is not', () => {
    expect(quoted('a/b.c-1')).toBe('a/b.c-1');
    expect(quoted('$(reboot)')).toBe(`'$(reboot)'`);
    expect(quoted('')).toBe(`''`);
  });
});

describe('an example of a schema', () => {
  test('one that holds itself ends', () => {
    expect(
      JSON.stringify(example_of(api, { $ref: '#/components/schemas/Tree' })).length,
    ).toBeLessThan(200);
  });
  test('bounds are kept', () => {
    expect(example_of(api, { type: 'number', minimum: 5 })).toBe(5);
    expect(example_of(api, { type: 'number', exclusiveMinimum: 0, maximum: 0.5 })).toBe(0.5);
    expect(example_of(api, { type: ['integer', 'null'], maximum: -3 })).toBe(-3);
    expect(example_of(api, { type: 'array', minItems: 3, items: { type: 'integer' } })).toEqual([
      1, 1, 1,
    ]);
  });
  test('a name that leads nowhere is null', () => {
    expect(example_of(api, { $ref: '#/components/schemas/Gone' })).toBe(null);
  });
});

test('every call of the document has its line, and nothing else is touched', () => {
  const out = with_curl(api, 'http://r');
  for (const methods of Object.values(out.paths))
    for (const operation of Object.values(methods))
      expect(operation['x-code-samples']?.[0]?.source).toMatch(/^curl -s /);
  expect(api.paths['/vehicle']?.['get']).toEqual({});
});

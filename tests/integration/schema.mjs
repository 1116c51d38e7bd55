// Checks a value against the part of JSON Schema that openapi.json uses.

const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value);

const typeChecks = {
  string: (v) => typeof v === 'string',
  number: (v) => typeof v === 'number',
  integer: (v) => Number.isInteger(v),
  boolean: (v) => typeof v === 'boolean',
  null: (v) => v === null,
  array: Array.isArray,
  object: isObject,
};

const known = new Set(['$ref', 'type', 'properties', 'required', 'additionalProperties', 'items', 'enum', 'const', 'oneOf',
  'pattern', 'format', 'description', 'minimum', 'maximum']);

/** A list of complaints, empty if the value fits. */
export function complaints(document, schema, value, where = '$') {
  if (schema === true || schema === undefined) return [];
  if (schema.$ref) {
    const target = schema.$ref.slice(2).split('/').reduce((node, key) => node[key], document);
    return complaints(document, target, value, where);
  }
  const found = [];
  for (const key of Object.keys(schema)) if (!known.has(key)) found.push(`${where}: the checker does not know "${key}"`);
  if (schema.oneOf) {
    const fits = schema.oneOf.filter((one) => complaints(document, one, value, where).length === 0).length;
    if (fits !== 1) found.push(`${where}: fits ${fits} of oneOf`);
  }
  if (schema.type && ![schema.type].flat().some((type) => typeChecks[type](value))) {
    return [...found, `${where}: is ${JSON.stringify(value)?.slice(0, 60)}, not ${schema.type}`];
  }
  if (schema.enum && !schema.enum.includes(value)) found.push(`${where}: ${value} is none of ${schema.enum}`);
  if ('const' in schema && schema.const !== value) found.push(`${where}: ${value} is not ${schema.const}`);
  if (schema.pattern && !new RegExp(schema.pattern).test(value)) found.push(`${where}: ${value} does not fit ${schema.pattern}`);
  if (schema.format === 'date-time' && Number.isNaN(Date.parse(value))) found.push(`${where}: ${value} is no time`);
  if (schema.items && Array.isArray(value)) {
    value.forEach((item, i) => found.push(...complaints(document, schema.items, item, `${where}[${i}]`)));
  }
  if (isObject(value)) found.push(...memberComplaints(document, schema, value, where));
  return found;
}

function memberComplaints(document, schema, value, where) {
  const found = [];
  for (const name of schema.required ?? []) if (!(name in value)) found.push(`${where}.${name}: is missing`);
  for (const [name, member] of Object.entries(value)) {
    const inner = schema.properties?.[name] ?? schema.additionalProperties;
    if (inner === false) found.push(`${where}.${name}: is not described`);
    else found.push(...complaints(document, inner, member, `${where}.${name}`));
  }
  return found;
}

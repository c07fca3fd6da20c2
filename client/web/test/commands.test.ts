import { describe, expect, it } from 'vitest';
import { deleteCommand, fillCommand } from '../src/ui/commands';

describe('commands for what a page may not do', () => {
  it('name the server of the page, and what they are about', () => {
    expect(fillCommand('water.example')).toMatch(/^meniscus simulate .* --server water\.example$/);
    const name = { session: '01234567-89ab-cdef-0123-456789abcdef', number: 7 };
    expect(deleteCommand('[::1]', name)).toBe(`meniscus recordings --server [::1] --delete ${name.session}/7`);
  });
});

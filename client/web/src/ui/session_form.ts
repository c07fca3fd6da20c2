// How a session's id is written: a UUID in its canonical form.

export const sessionForm = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

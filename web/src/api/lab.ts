/** Every request that the pages make, one function each. */
import { base, query, request } from './client';
import { readDefinition, type ExperimentDefinition } from './experiment';
import type { Booking, CreatedUser, Fit, LiveTicket, NewBooking, NewUser, Rig, Run, RunPage, Session, User } from './types';

const id = encodeURIComponent;

export const signIn = (username: string, password: string) => request<Session>('POST', '/session', { username, password });
export const currentSession = () => request<Session>('GET', '/session');
export const signOut = () => request<void>('DELETE', '/session');
export const changePassword = (current: string, next: string) => request<Session>('PUT', '/session/password', { current, new: next });

export const users = async () => (await request<{ users: User[] }>('GET', '/users')).users;
export const addUser = (user: NewUser) => request<CreatedUser>('POST', '/users', user);

export const rigs = async () => (await request<{ rigs: Rig[] }>('GET', '/rigs')).rigs;
export const rig = (rigId: string) => request<Rig>('GET', `/rigs/${id(rigId)}`);
export const cameraUrl = (rigId: string) => `${base}/rigs/${id(rigId)}/camera.jpg`;
export const liveTicket = (rigId: string) => request<LiveTicket>('POST', `/rigs/${id(rigId)}/live-ticket`);
export const liveUrl = (rigId: string, ticket: string) => `${base}/rigs/${id(rigId)}/live?ticket=${id(ticket)}`;

export const experiment = async (name: string): Promise<ExperimentDefinition> =>
  readDefinition(name, await request<unknown>('GET', `/experiments/${id(name)}`));

export const myBookings = async () => (await request<{ bookings: Booking[] }>('GET', '/bookings')).bookings;
export const rigBookings = async (rigId: string, from: Date, to: Date) =>
  (await request<{ bookings: Booking[] }>('GET', `/rigs/${id(rigId)}/bookings${query({ from: wireTime(from), to: wireTime(to) })}`)).bookings;
export const book = (booking: NewBooking) => request<Booking>('POST', '/bookings', booking);
export const cancelBooking = (bookingId: number) => request<void>('DELETE', `/bookings/${bookingId}`);

export const prepareRun = (rigId: string, experimentId: string, parameters: Record<string, number>) =>
  request<Run>('POST', '/runs', { rig: rigId, experiment: experimentId, parameters });
export const runs = (filter: { limit?: number; before?: number | undefined; rig?: string; mine?: boolean }) =>
  request<RunPage>('GET', `/runs${query(filter)}`);
export const run = (runId: number) => request<Run>('GET', `/runs/${runId}`);
export const commandRun = (runId: number, command: 'release' | 'stop' | 'abort') => request<Run>('POST', `/runs/${runId}/${command}`);
export const fit = (runId: number) => request<Fit>('GET', `/runs/${runId}/fit`);
export const posesCsvUrl = (runId: number) => `${base}/runs/${runId}/poses.csv`;

/** Whole seconds in UTC, as the interface writes them. */
export function wireTime(time: Date | number): string {
  return new Date(time).toISOString().replace(/\.\d+Z$/, 'Z');
}
